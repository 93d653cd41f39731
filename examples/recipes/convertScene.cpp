// SPDX-License-Identifier: MIT
#include <osgSkinBind/ConvertRigs>

#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgDB/ReadFile>

#include <iostream>
#include <stdexcept>

/// The same scene twice: on the left as osgAnimation skins it, on the right with our skins in it.
///
/// \param file any that OSG reads with an osgAnimation::RigGeometry
osg::ref_ptr<osg::Node> convertScene(const std::string& file) {
    osg::ref_ptr<osg::Group> both = new osg::Group;
    for (const bool isConverted : {false, true}) {
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file);
        if (!scene)
            throw std::runtime_error(file + ": OSG cannot read it; expected a scene with a rig");
        if (isConverted) {
            osgSkin::ConvertOptions options;
            options.ratios = osgSkin::ConvertOptions::Ratios::Own; // Painted, Best: by the weights
            const osgSkin::ConvertReport report = osgSkin::convertRigs(*scene, options);
            std::cout << report.skins.size() << " skins\n";
            for (const std::string& note : report.notes) std::cout << note << '\n';
            if (report.skins.empty()) throw std::runtime_error(file + ": no rig to convert");
        }
        using Manager = osgAnimation::BasicAnimationManager; // it plays nothing by itself
        auto* manager = dynamic_cast<Manager*>(scene->getUpdateCallback());
        if (manager && !manager->getAnimationList().empty())
            manager->playAnimation(manager->getAnimationList().back());
        const double aside = 0.5 * double(scene->getBound().radius());
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(
            osg::Matrix::translate(isConverted ? aside : -aside, 0.0, 0.0));
        place->addChild(scene);
        both->addChild(place);
    }
    return both;
}
