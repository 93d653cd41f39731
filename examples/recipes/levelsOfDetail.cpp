// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osg/LOD>
#include <osg/MatrixTransform>

namespace {

/// One skeleton with two skins: the fine one up to 4 metres, the coarse one up to 50.
osg::ref_ptr<osg::Node> makeLevels(const std::string& fineFile, const std::string& coarseFile) {
    osgSkin::LoadOptions options;
    options.mergeRigid = true; // head, hands and feet, too, in the skins
    osgSkin::Character fine = osgSkin::loadCharacter(fineFile, options);
    options.atRest = true; // its own skeleton is not used
    osgSkin::Character coarse = osgSkin::loadCharacter(coarseFile, options);

    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    for (const osgSkin::Character* body : {&fine, &coarse})
        for (const osgSkin::AttachedSkin::Skin& skin : body->skin.skins) {
            levels->addChild(skin.drawable, body == &fine ? 0.0f : 4.0f,
                             body == &fine ? 4.0f : 50.0f);
            skin.drawable->getParent(0)->removeChild(skin.drawable);
        }
    fine.skeleton->addChild(levels); // the last child: skins are updated after the bones
    return fine.root;
}

} // namespace

/// Two such figures, 1.5 metres apart. The coarse body, for the same skeleton, is coarse.skin.
osg::ref_ptr<osg::Node> levelsOfDetail(const std::string& file) {
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const double step : {0.0, 1.0}) {
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(0.8 * step, 1.5 * step, 0.0));
        place->addChild(makeLevels(file, file.substr(0, file.rfind('/') + 1) + "coarse.skin"));
        scene->addChild(place);
    }
    return scene;
}
