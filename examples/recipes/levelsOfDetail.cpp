// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osg/LOD>
#include <osg/MatrixTransform>

/// One skeleton with two skins: the fine one is drawn where it is large in the picture.
/// \param coarse file of a body with fewer triangles and the same joints
osg::ref_ptr<osg::Node> makeLevels(const std::string& file, const std::string& coarse) {
    osgSkin::LoadOptions options;
    options.mergeRigid = true; // head, hands and feet, too, in the skins
    osgSkin::Character fine = osgSkin::loadCharacter(file, options);
    options.atRest = true; // its own skeleton is not used
    osgSkin::Character other = osgSkin::loadCharacter(coarse, options);

    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN); // whatever unit the figure has
    for (const osgSkin::Character* body : {&fine, &other})
        for (const osgSkin::AttachedSkin::Skin& skin : body->skin.skins) {
            levels->addChild(skin.drawable, body == &fine ? 500.0f : 5.0f,
                             body == &fine ? 1e9f : 500.0f);
            skin.drawable->getParent(0)->removeChild(skin.drawable);
        }
    fine.skeleton->addChild(levels); // the last child: skins are updated after the bones
    return fine.root;
}

/// Two such figures, one farther away.
osg::ref_ptr<osg::Node> levelsOfDetail(const std::string& file, const std::string& coarse) {
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const double step : {0.0, 1.0}) {
        const osg::ref_ptr<osg::Node> figure = makeLevels(file, coarse);
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(
            osg::Matrix::translate(osg::Vec3d(0.8, 2, 0) * step * figure->getBound().radius()));
        place->addChild(figure);
        scene->addChild(place);
    }
    return scene;
}
