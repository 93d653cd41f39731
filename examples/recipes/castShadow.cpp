// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osg/ComputeBoundsVisitor>
#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgShadow/ShadowMap>
#include <osgShadow/ShadowedScene>

/// A figure that casts a shadow on the floor and on itself.
osg::ref_ptr<osg::Node> castShadow(const std::string& file) {
    const unsigned int receives = 1, casts = 2;
    const osg::ref_ptr<osgShadow::ShadowMap> map = new osgShadow::ShadowMap;
    map->setTextureSize(osg::Vec2s(2048, 2048));
    const osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene(map);
    scene->setReceivesShadowTraversalMask(receives);
    scene->setCastsShadowTraversalMask(casts);

    const osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    light->getLight()->setPosition(osg::Vec4(-2, -5, 4, 0));
    map->setLight(light);
    scene->addChild(light);

    const osgSkin::Character character = osgSkin::loadCharacter(file);
    character.root->setNodeMask(receives | casts);
    scene->addChild(character.root);

    osg::ComputeBoundsVisitor figure;
    character.root->accept(figure);
    const float size = 3 * figure.getBoundingBox().zMax();
    const osg::ref_ptr<osg::Node> floor = new osg::ShapeDrawable(
        new osg::Box(osg::Vec3(0, 0, -0.01f * size), size, size, 0.02f * size));
    floor->setNodeMask(receives);
    scene->addChild(floor);
    return scene;
}
