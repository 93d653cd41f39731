// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osg/ComputeBoundsVisitor>
#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgText/Text>

/// A figure that stands on the Earth, 6,371 kilometres from the origin of the world.
osg::ref_ptr<osg::Node> largeWorld(const std::string& file) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);

    // East, north and up at a place, in double precision: x, y and z of everything below.
    osg::Matrixd place;
    const osg::EllipsoidModel earth;
    earth.computeLocalToWorldTransformFromLatLongHeight(osg::DegreesToRadians(37.57),
                                                        osg::DegreesToRadians(126.98), 38.0, place);
    const osg::ref_ptr<osg::MatrixTransform> here = new osg::MatrixTransform(place);
    here->addChild(character.root);
    osg::ComputeBoundsVisitor figure;
    character.root->accept(figure);
    const float height = figure.getBoundingBox().zMax(), size = 1.7f * height;
    here->addChild(new osg::ShapeDrawable(
        new osg::Box(osg::Vec3(0, 0, -0.05f * size), size, size, 0.1f * size)));

    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setText(std::to_string(int(place.getTrans().length())) + " m");
    text->setPosition(osg::Vec3(-0.4f, -0.5f, 0.01f) * height); // in floats: near to its origin
    text->setCharacterSize(0.14f * height);
    here->addChild(text);

    const osg::ref_ptr<osg::Group> world = new osg::Group;
    world->addChild(here);
    return world;
}
