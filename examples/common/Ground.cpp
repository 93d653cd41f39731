// SPDX-License-Identifier: MIT
#include "Ground.h"

#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/PolygonOffset>
#include <osg/ShadeModel>

namespace example {
namespace {

const osg::Vec4 kFloorColour(0.30f, 0.32f, 0.35f, 1.0f);
const osg::Vec4 kLineColour(0.36f, 0.385f, 0.42f, 1.0f);
const osg::Vec4 kShadowColour(0.20f, 0.215f, 0.235f, 1.0f);
const osg::Vec3 kToLight(-0.35f, -0.45f, 1.0f);

osg::ref_ptr<osg::Geometry> makeFlat(osg::Vec3Array* vertices, const osg::Vec4& colour,
                                     GLenum mode) {
    const osg::ref_ptr<osg::Vec4Array> colours = new osg::Vec4Array;
    colours->push_back(colour);
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->setColorArray(colours, osg::Array::BIND_OVERALL);
    geometry->addPrimitiveSet(new osg::DrawArrays(mode, 0, static_cast<int>(vertices->size())));
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return geometry;
}

/// Projects along the light onto z = 0; for row vectors.
osg::Matrix shadowMatrix() {
    osg::Matrix matrix;
    matrix(2, 0) = -kToLight.x() / kToLight.z();
    matrix(2, 1) = -kToLight.y() / kToLight.z();
    matrix(2, 2) = 0.0;
    return matrix;
}

} // namespace

osg::ref_ptr<osg::Node> makeFloor(float size, float spacing) {
    const osg::ref_ptr<osg::Vec3Array> quad = new osg::Vec3Array;
    for (const auto& corner :
         {osg::Vec2(-1, -1), osg::Vec2(1, -1), osg::Vec2(1, 1), osg::Vec2(-1, 1)})
        quad->push_back({size * corner.x(), size * corner.y(), 0.0f});
    const osg::ref_ptr<osg::Vec3Array> lines = new osg::Vec3Array;
    const auto count = static_cast<int>(size / spacing);
    for (int line = -count; line <= count; ++line) {
        const float at = spacing * static_cast<float>(line);
        lines->push_back({at, -size, 0.0f});
        lines->push_back({at, size, 0.0f});
        lines->push_back({-size, at, 0.0f});
        lines->push_back({size, at, 0.0f});
    }
    const osg::ref_ptr<osg::Geometry> plane = makeFlat(quad, kFloorColour, GL_QUADS);
    // The lines and the shadow lie in the same plane, so move the floor behind both.
    plane->getOrCreateStateSet()->setAttributeAndModes(new osg::PolygonOffset(2.0f, 2.0f));
    osg::ref_ptr<osg::Group> floor = new osg::Group;
    floor->addChild(plane);
    floor->addChild(makeFlat(lines, kLineColour, GL_LINES));
    return floor;
}

osg::ref_ptr<osg::Group> withShadow(osg::Node* figure) {
    osg::ref_ptr<osg::Group> group = new osg::Group;
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    osg::Light& light = *source->getLight();
    light.setPosition(osg::Vec4(kToLight, 0.0f));
    light.setAmbient(osg::Vec4(0.32f, 0.32f, 0.34f, 1.0f));
    light.setDiffuse(osg::Vec4(0.78f, 0.76f, 0.72f, 1.0f));
    group->addChild(source);
    group->addChild(figure);

    const osg::ref_ptr<osg::MatrixTransform> shadow = new osg::MatrixTransform(shadowMatrix());
    shadow->addChild(figure);
    osg::StateSet& state = *shadow->getOrCreateStateSet();
    const osg::ref_ptr<osg::Material> dark = new osg::Material;
    dark->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
    dark->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
    dark->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
    dark->setEmission(osg::Material::FRONT_AND_BACK, kShadowColour);
    const auto override = osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE;
    state.setAttributeAndModes(dark, override);
    state.setAttributeAndModes(new osg::PolygonOffset(1.0f, 1.0f), override);
    state.setTextureMode(0, GL_TEXTURE_2D,
                         osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    group->addChild(shadow);
    return group;
}

} // namespace example
