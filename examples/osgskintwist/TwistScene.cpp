// SPDX-License-Identifier: MIT
#include "TwistScene.h"

#include "Labels.h"

#include <Ground.h>

#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>

#include <cstdio>

namespace twist {
namespace {

constexpr float kSpacing = 6.4f; ///< a copy bent by 90 degrees does not reach the next one
const std::array<osg::Vec3, kMethods.size()> kColours{
    osg::Vec3(0.10f, 0.55f, 0.45f), osg::Vec3(0.85f, 0.42f, 0.12f), osg::Vec3(0.25f, 0.42f, 0.80f)};

float placeOf(std::size_t copy) {
    return kSpacing * (static_cast<float>(copy) - 1.0f);
}

/// From the camera's side, so that what the sun leaves in its own shade still shows its chequers.
osg::ref_ptr<osg::Node> makeFillLight() {
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    osg::Light& light = *source->getLight();
    light.setLightNum(1);
    light.setPosition(osg::Vec4(0.1f, -1.0f, 0.1f, 0.0f));
    light.setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light.setDiffuse(osg::Vec4(0.42f, 0.42f, 0.44f, 1.0f));
    return source;
}

void show(osg::Node& node, bool visible) {
    node.setNodeMask(visible ? ~0u : 0u);
}

} // namespace

example::View sceneView() {
    return {{1.4, -54.0, 11.0}, {1.4, 0.0, 3.3}, {0, 0, 1}, 11.5};
}

TwistScene::TwistScene()
    : _figures(_comparison.cylinder()), _root(new osg::Group),
      _title(makeText(26.0f, osgText::Text::LEFT_TOP)),
      _help(makeText(18.0f, osgText::Text::LEFT_TOP)) {
    const osg::ref_ptr<osg::Group> figures = new osg::Group;
    const osg::ref_ptr<osg::Group> labels = new osg::Group;
    for (std::size_t i = 0; i < kMethods.size(); ++i) {
        _copies[i] = makeCopy(kMethods[i], kColours[i], placeOf(i));
        figures->addChild(_copies[i]);
        _labels[i] = makeLabel(osg::Vec3(placeOf(i), -1.6f, 0.0f));
        labels->addChild(_labels[i]);
    }
    const osg::ref_ptr<osg::Group> lit = example::withShadow(figures);
    lit->addChild(makeFillLight());
    lit->addChild(example::makeFloor(40.0f));
    lit->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    _root->addChild(lit);
    _root->addChild(labels);
    _root->addChild(makeOverlay(_title, _help));
    setPose({});
}

osg::ref_ptr<osg::Node> TwistScene::makeCopy(Method method, const osg::Vec3& colour, float x) {
    osg::ref_ptr<osg::MatrixTransform> copy = new osg::MatrixTransform(
        osg::Matrix::translate(x, 0.0, Cylinder::kHalfLength)); // on the floor
    copy->setDataVariance(osg::Object::DYNAMIC);
    copy->addChild(_comparison.node(method));
    const osg::ref_ptr<osg::Material> white = new osg::Material; // the texture has the colours
    white->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(0.85f, 0.85f, 0.85f, 1.0f));
    white->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.85f, 0.85f, 0.85f, 1.0f));
    copy->getOrCreateStateSet()->setAttributeAndModes(white);
    copy->getOrCreateStateSet()->setTextureAttributeAndModes(
        0, makeChequers(Cylinder::kChequersAround, colour));
    return copy;
}

void TwistScene::setPose(const TwistPose& pose) {
    _pose = pose;
    _comparison.setPose(pose);
    char text[120];
    for (std::size_t i = 0; i < kMethods.size(); ++i) {
        const Figures figures = _figures.measure(_comparison.positions(kMethods[i]), pose);
        std::snprintf(text, sizeof text, "%s\nvolume %.2f\nleast area %.2f\nedge strain %.2f",
                      nameOf(kMethods[i]), figures.volume, figures.leastArea, figures.strain.rms);
        _labels[i]->setText(text);
    }
    std::snprintf(text, sizeof text, "bend %.0f    twist %.0f", pose.bend, pose.twist);
    _title->setText(text);
}

void TwistScene::toggle(std::size_t copy) {
    const bool visible = _copies[copy]->getNodeMask() == 0u;
    show(*_copies[copy], visible);
    show(*_labels[copy], visible);
}

void TwistScene::setHelp(const std::string& lines) {
    _help->setText(lines);
}

} // namespace twist
