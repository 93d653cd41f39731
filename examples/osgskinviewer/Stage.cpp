// SPDX-License-Identifier: MIT
#include "Stage.h"

#include "Drawing.h"
#include "Ground.h"
#include "Keys.h"

#include <osg/FrameStamp>
#include <osg/NodeCallback>
#include <osg/PolygonMode>
#include <osg/Timer>
#include <osgSkin/GlmOsg>
#include <osgSkinBind/ShowRegions>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace viewer {

using figures::Method;

namespace {

const char* nameOf(Method method) {
    return method == Method::Ours     ? "osgSkin"
           : method == Method::Linear ? "linear blending"
                                      : "dual quaternions";
}

/// Keeps a node out of sight where another figure stands in for it; it is updated still.
class Hide : public osg::NodeCallback {
public:
    explicit Hide(const bool& shown) : _shown(shown) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        if (_shown) traverse(node, nv);
    }

private:
    const bool& _shown;
};

/// The same for a drawable.
class HideSkin : public osg::DrawableCullCallback {
public:
    explicit HideSkin(const bool& shown) : _shown(shown) {}
    bool cull(osg::NodeVisitor*, osg::Drawable*, osg::RenderInfo*) const override {
        return !_shown;
    }

private:
    const bool& _shown;
};

osg::ref_ptr<osg::Geometry> makeBox(const osg::BoundingBox& box, const osg::Matrix& toWorld) {
    std::vector<osg::Vec3> points;
    for (unsigned int corner = 0; corner < 8; ++corner)
        for (unsigned int axis = 1; axis < 8; axis *= 2)
            if (!(corner & axis))
                for (const unsigned int end : {corner, corner | axis})
                    points.push_back(box.corner(end) * toWorld);
    return figures::makeLines(points, osg::Vec4(0.95f, 0.8f, 0.3f, 1), GL_LINES, 1.5f);
}

} // namespace

/// Runs after the character's own updates: it stands behind it in the scene.
class Stage::Update : public osg::NodeCallback {
public:
    explicit Update(Stage& stage) : _stage(stage) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        _stage._given = nv->getFrameStamp()->getSimulationTime();
        _stage.update();
        traverse(node, nv);
    }

private:
    Stage& _stage;
};

Stage::Stage(const std::string& character, const std::string& weights, int width, int height)
    : _body(character, weights), _bones(_body.character.binding.joints, *_body.character.skeleton),
      _root(new osg::Group), _study(new osg::Group), _lines(new osg::Group),
      _boxes(new osg::Group) {
    const osgSkin::Character& loaded = _body.character;
    for (const auto& skin : loaded.skin.skins)
        skin.drawable->setCullCallback(new HideSkin(_productShown));
    for (const auto& rigid : loaded.skin.rigids)
        rigid.node->setCullCallback(new Hide(_productShown));
    _study->setUpdateCallback(new Update(*this));
    _study->setCullingActive(false);

    const osg::ref_ptr<osg::Group> figure = new osg::Group;
    figure->addChild(loaded.root);
    figure->addChild(_study);
    _look = figure->getOrCreateStateSet();
    const double size = loaded.body.mesh.size();
    const osg::ref_ptr<osg::Group> lit = figures::makeLit();
    lit->addChild(figure);
    _root->addChild(lit);
    _root->addChild(example::makeFloor(static_cast<float>(5.0 * size)));
    _root->addChild(_lines);
    _root->addChild(_boxes);

    const osg::ref_ptr<osg::Camera> overlay = figures::makeCaption("", width, height, 16.0f);
    _status = static_cast<osgText::Text*>(overlay->getChild(0));
    const osg::ref_ptr<osgText::Text> help = figures::makeText(
        keysHelp(), osg::Vec3(14.0f, static_cast<float>(height) - 28.0f, 0), 16.0f);
    _help = help;
    overlay->addChild(help);
    _root->addChild(overlay);
    // The joints lie inside the skin: they are drawn over it.
    _lines->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    _lines->getOrCreateStateSet()->setRenderBinDetails(5, "RenderBin");
    changeJoint(1);
    if (motionCount() > 0) clock = Clock(motionLength(0));
}

double Stage::motionLength(std::size_t index) const {
    return _body.character.motions[index].duration();
}

void Stage::setMotion(std::size_t index) {
    _motion = index % motionCount();
    osgAnimation::BasicAnimationManager& manager = *_body.character.manager;
    manager.stopAll();
    manager.playAnimation(manager.getAnimationList()[_motion]);
    _start = _given; // it starts at the time of the manager's last update
    const Clock before = clock;
    clock = Clock(motionLength(_motion));
    clock.playing = before.playing;
    clock.speed = before.speed;
}

void Stage::setMotion(const std::string& name) {
    for (std::size_t i = 0; i < motionCount(); ++i)
        if (_body.character.motions[i].name() == name) return setMotion(i);
    throw std::runtime_error(_body.character.file + ": expected a motion called \"" + name + "\"");
}

void Stage::changeJoint(int step) {
    const osgSkin::Binding& binding = _body.character.binding;
    std::vector<bool> followed(binding.joints.size());
    for (const osgSkin::Influence& i : binding.influences)
        if (i.joint > 0 && (i.bend < 1.0f || i.twist < 1.0f)) followed[i.joint] = true;
    const std::size_t count = followed.size();
    for (std::size_t tries = 0; tries < count; ++tries) {
        settings.joint = (settings.joint + count + static_cast<std::size_t>(step + 1) - 1) % count;
        if (followed[settings.joint]) return;
    }
}

example::View Stage::view() const {
    const osg::BoundingSphere& all = _body.character.root->getBound();
    return {all.center() + osg::Vec3d(0.35, -0.95, 0.2) * (2.9 * all.radius()), all.center()};
}

osg::Vec4 Stage::colourOf(std::size_t vertex) const {
    const osgSkin::Binding& binding = _body.character.binding;
    if (settings.colours == Colours::Regions) return osgSkin::regionColor(binding.regions[vertex]);
    if (settings.colours == Colours::Own) return figures::kSkin;
    const osgSkin::Influence share = figures::influenceOf(binding, vertex, settings.joint);
    return figures::ratioColour(
        static_cast<double>(settings.colours == Colours::Bend ? share.bend : share.twist));
}

void Stage::updateFigure(const std::vector<glm::dmat4>& skinning) {
    _study->removeChildren(0, _study->getNumChildren());
    _productShown = settings.method == Method::Ours && settings.colours == Colours::Own;
    const osg::ElapsedTime timer;
    if (_productShown) {
        for (const auto& skin : _body.character.skin.skins) skin.drawable->getDeformedGeometry();
        _skinTime = timer.elapsedTime_m();
        return;
    }
    const std::vector<glm::dvec3> posed = _body.deform(settings.method, skinning);
    _skinTime = timer.elapsedTime_m();
    _study->addChild(
        figures::makeSkin(_body, posed, [this](std::size_t v) { return colourOf(v); }));
}

void Stage::updateSkeleton(const std::vector<glm::dmat4>& skinning) {
    _lines->removeChildren(0, _lines->getNumChildren());
    if (!settings.skeleton) return;
    const auto& joints = _body.character.binding.joints;
    std::vector<osg::Vec3> bones, places;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        places.push_back(figures::toScene(
            _body.toWorld(glm::dvec3(skinning[j] * glm::dvec4(joints[j].centre, 1.0)))));
        if (joints[j].parent < 0) continue;
        bones.push_back(places[static_cast<std::size_t>(joints[j].parent)]);
        bones.push_back(places.back());
    }
    _lines->addChild(figures::makeLines(bones, osg::Vec4(0.3f, 0.85f, 0.95f, 1), GL_LINES, 3.0f));
    _lines->addChild(figures::makeLines(places, osg::Vec4(1, 1, 1, 1), GL_POINTS, 6.0f));
}

void Stage::updateBounds() {
    _boxes->removeChildren(0, _boxes->getNumChildren());
    if (!settings.bounds) return;
    const osg::Matrix toWorld =
        static_cast<osg::MatrixTransform&>(*_body.character.skeleton->getParent(0)).getMatrix();
    for (const auto& skin : _body.character.skin.skins)
        _boxes->addChild(makeBox(skin.drawable->getBoundingBox(), toWorld));
}

void Stage::update() {
    const osg::Timer_t now = osg::Timer::instance()->tick();
    if (_lastFrame) {
        const double last = osg::Timer::instance()->delta_m(_lastFrame, now);
        _frameTime = _frameTime > 0.0 ? 0.9 * _frameTime + 0.1 * last : last;
    }
    _lastFrame = now;

    const std::vector<glm::dmat4>& skinning = _bones.read();
    updateFigure(skinning);
    updateSkeleton(skinning);
    updateBounds();
    const osg::ref_ptr<osg::PolygonMode> mode =
        new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK,
                             settings.wireframe ? osg::PolygonMode::LINE : osg::PolygonMode::FILL);
    _look->setAttribute(mode, osg::StateAttribute::OVERRIDE | osg::StateAttribute::ON);
    _help->setNodeMask(settings.help ? ~0u : 0u);
    _status->setNodeMask(settings.status ? ~0u : 0u);
    char times[80];
    std::snprintf(times, sizeof times, "\n%.1f ms a frame, the skin %.3f ms; h: keys", _frameTime,
                  _skinTime);
    std::string text = summary();
    text.replace(text.find("; "), 2, "\n");
    _status->setText(text + times);
}

std::string Stage::summary() const {
    const osgSkin::Character& character = _body.character;
    char time[80] = "at rest";
    if (motionCount() > 0)
        std::snprintf(time, sizeof time, "%s %.2f of %.2f s, %s x%g",
                      character.motions[_motion].name().c_str(), clock.time(), clock.length(),
                      clock.playing ? "playing" : "paused", clock.speed);
    std::string text = std::string(time) + "; " + nameOf(settings.method);
    if (settings.colours == Colours::Regions) text += "; regions";
    if (settings.colours == Colours::Bend || settings.colours == Colours::Twist)
        text += std::string(settings.colours == Colours::Bend ? "; bend" : "; twist") +
                " ratios of " + character.binding.joints[settings.joint].name;
    if (settings.skeleton) text += "; skeleton";
    if (settings.wireframe) text += "; wireframe";
    if (settings.bounds) text += "; bounds";
    return text;
}

} // namespace viewer
