// SPDX-License-Identifier: MIT
#include "Stage.h"

#include "Drawing.h"
#include "Ground.h"
#include "Keys.h"
#include "Snapshots.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/SetMorph>
#include <osgSkinBind/ShowRegions>
#include <osgSkinMotion/HitBoxes>

#include <osg/Array>
#include <osg/FrameStamp>
#include <osg/LineWidth>
#include <osg/NodeCallback>
#include <osg/PolygonMode>
#include <osg/Transform>
#include <osgAnimation/Bone>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace viewer {

void Clock::advance(double seconds) {
    if (playing) seek(_time + speed * seconds);
}

void Clock::seek(double seconds) {
    _time = _length > 0.0 ? seconds - _length * std::floor(seconds / _length) : 0.0;
}

namespace {

std::vector<glm::vec3> asVectors(const osg::Array& array) {
    std::vector<glm::vec3> result;
    for (const osg::Vec3& v : static_cast<const osg::Vec3Array&>(array))
        result.emplace_back(v.x(), v.y(), v.z());
    return result;
}

} // namespace

NormalsSwitch::NormalsSwitch(const osgSkin::Character& character) {
    if (character.binding.gradients.empty()) return;
    osgSkin::Binding turned = character.binding;
    turned.gradients.clear();
    turned.correctives.normalShares.clear();
    for (osgSkin::CorrectiveJoint& joint : turned.correctives.joints) joint.normalScales.clear();
    for (const osgSkin::SkinParts::Skin& skin : character.skin.skins) {
        osg::Geometry* rest = skin.part.geometry;
        if (!rest) continue;
        _skins.push_back({skin.drawable, rest, skin.drawable->getModel(),
                          osgSkin::SkinModel::create(turned, asVectors(*rest->getVertexArray()),
                                                     asVectors(*rest->getNormalArray()),
                                                     skin.part.sourceVertex)});
    }
}

void NormalsSwitch::showTurned(bool turned) {
    for (const Skin& skin : _skins)
        skin.drawable->setSkin(skin.rest, turned ? skin.turned : skin.surface);
}

using figures::Method;
using Timer = std::chrono::steady_clock;

namespace {

const char* nameOf(Method method) {
    return method == Method::Ours     ? "osgSkin"
           : method == Method::Plain  ? "osgSkin without shapes"
           : method == Method::Linear ? "linear blending"
                                      : "dual quaternions";
}

/// Hides a node that is replaced by another figure, but keeps updating it.
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

/// The bones of a scene, as lines and points in its space.
class BoneLines : public osg::NodeVisitor {
public:
    BoneLines() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Transform& node) override {
        if (dynamic_cast<osgAnimation::Bone*>(&node) == nullptr) return traverse(node);
        points.push_back(osg::Vec3() * osg::computeLocalToWorld(getNodePath()));
        if (!_above.empty()) lines.insert(lines.end(), {_above.back(), points.back()});
        _above.push_back(points.back());
        traverse(node);
        _above.pop_back();
    }

    std::vector<osg::Vec3> points, lines;

private:
    std::vector<osg::Vec3> _above;
};

/// The approximate size of a figure in the scene, not including its path.
double sizeOf(const Figure& figure) {
    double result = 0.0;
    for (const auto& skin : figure.skins) {
        const osg::BoundingBox& box = skin->getBoundingBox();
        const osg::NodePathList paths = skin->getParentalNodePaths();
        if (!box.valid() || paths.empty()) continue;
        const osg::Matrixd toScene = osg::computeLocalToWorld(paths.front());
        const osg::Vec3d diagonal = osg::Vec3d(box._max) - osg::Vec3d(box._min);
        result = std::max(result, osg::Matrixd::transform3x3(diagonal, toScene).length());
    }
    return result > 0.0 ? result : 1.0;
}

/// Distance of the floor's lines: the power of ten closest to half the figure's size. For a person
/// in any metric unit, that is a metre.
float lineSpacing(double size) {
    return static_cast<float>(std::pow(10.0, std::round(std::log10(0.5 * size))));
}

double millisecondsSince(Timer::time_point start) {
    return std::chrono::duration<double, std::milli>(Timer::now() - start).count();
}

} // namespace

/// Runs after the character's own updates, because it follows the character in the scene.
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

Stage::Stage(const std::string& character, const std::string& weights,
             const osgSkin::LoadOptions& options, int width, int height)
    : _file(character), _figure(character, weights, options), _root(new osg::Group),
      _study(new osg::Group), _lines(new osg::Group), _boxes(new osg::Group),
      _floor(new osg::MatrixTransform), _aspect(static_cast<double>(width) / height) {
    if (hasBody()) {
        const osgSkin::Character& loaded = _figure.body->character;
        _bones.emplace(loaded.binding.joints, *loaded.skeleton);
        for (const auto& skin : loaded.skin.skins)
            skin.drawable->setCullCallback(new HideSkin(_productShown));
        for (const auto& rigid : loaded.skin.rigids)
            rigid.node->setCullCallback(new Hide(_productShown));
    }
    _study->setUpdateCallback(new Update(*this));
    _study->setCullingActive(false);

    const osg::ref_ptr<osg::Group> figure = new osg::Group;
    figure->addChild(_figure.root);
    figure->addChild(_study);
    _state = figure->getOrCreateStateSet();
    const osg::ref_ptr<osg::Group> lit = figures::makeLit();
    lit->addChild(figure);
    _root->addChild(lit);
    const double size = sizeOf(_figure);
    const double reach = 5.0 * size + static_cast<double>(_figure.root->getBound().radius());
    _floor->addChild(example::makeFloor(static_cast<float>(reach), lineSpacing(size)));
    _root->addChild(_floor);
    _root->addChild(_lines);
    _root->addChild(_boxes);

    const osg::ref_ptr<osg::Camera> overlay = figures::makeCaption("", width, height, 16.0f);
    _status = static_cast<osgText::Text*>(overlay->getChild(0));
    const osg::ref_ptr<osgText::Text> help = figures::makeText(
        keysHelp(), osg::Vec3(14.0f, static_cast<float>(height) - 28.0f, 0), 16.0f);
    _help = help;
    overlay->addChild(help);
    _morphList = figures::makeText(
        "", osg::Vec3(static_cast<float>(width) * 0.6f, static_cast<float>(height) - 28.0f, 0),
        16.0f);
    overlay->addChild(_morphList);
    for (const std::string& name : osgSkin::morphNames(*_figure.root))
        _morphs.emplace_back(name, osgSkin::getMorph(*_figure.root, name));
    _root->addChild(overlay);
    // The joints lie inside the skin, so they are drawn over it.
    _lines->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    _lines->getOrCreateStateSet()->setRenderBinDetails(5, "RenderBin");
    changeJoint(1);
    if (motionCount() > 0) clock = Clock(_figure.motion(0).getDuration());
    placeFloor();
}

void Stage::placeFloor() {
    _extent = playedExtent(_figure, _motion);
    const osg::Vec3d centre = _extent.box.center();
    const auto spacing = static_cast<double>(lineSpacing(sizeOf(_figure)));
    // Moves by whole squares, so that two lines cross at the origin.
    _floor->setMatrix(osg::Matrix::translate(spacing * std::round(centre.x() / spacing),
                                             spacing * std::round(centre.y() / spacing),
                                             _extent.floor));
}

void Stage::setMotion(std::size_t index) {
    _motion = index % motionCount();
    placeFloor();
    osgAnimation::BasicAnimationManager& manager = *_figure.manager;
    manager.stopAll();
    manager.playAnimation(&_figure.motion(_motion));
    _start = _given; // the manager starts it at the time of its last update
    const Clock before = clock;
    clock = Clock(_figure.motion(_motion).getDuration());
    clock.playing = before.playing;
    clock.speed = before.speed;
}

void Stage::setMotion(const std::string& name) {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < motionCount(); ++i) known.push_back(_figure.motion(i).getName());
    const std::vector<std::size_t> meant = osgSkin::clipsMeant(name, known);
    if (meant.size() == 1) return setMotion(meant.front());
    throw osgSkin::Error(_file + ": no motion is called \"" + name + '"' +
                         osgSkin::expectedNames(name, known));
}

void Stage::setJoint(const std::string& name) {
    if (!hasBody())
        throw std::runtime_error(_file + ": its ratios are not known, expected a .skin file or a "
                                         "rigged model");
    settings.joint = _figure.body->find(name);
}

void Stage::changeJoint(int step) {
    if (!hasBody()) return;
    const osgSkin::Binding& binding = _figure.body->character.binding;
    std::vector<bool> followed(binding.joints.size());
    for (const osgSkin::Influence& i : binding.influences)
        if (i.joint > 0 && (i.bend < 1.0f || i.twist < 1.0f)) followed[i.joint] = true;
    const std::size_t count = followed.size();
    for (std::size_t tries = 0; tries < count; ++tries) {
        settings.joint = (settings.joint + count + static_cast<std::size_t>(step + 1) - 1) % count;
        if (followed[settings.joint]) return;
    }
}

void Stage::turnNormals(bool on) {
    if (!hasBody()) return;
    if (!_normals) _normals.emplace(_figure.body->character);
    if (!_normals->canSwitch()) return;
    settings.turnedNormals = on;
    _normals->showTurned(on);
    tense(settings.tensed);
}

void Stage::showHitBoxes(bool on) {
    settings.hitBoxes = on;
    if (!_hitBoxes) {
        _hitBoxes = osgSkin::attach<osgSkin::HitBoxes>(*_figure.root)->makeLines();
        _hitBoxes->getOrCreateStateSet()->setAttribute(new osg::LineWidth(1.5f));
        _root->addChild(_hitBoxes);
    }
    _hitBoxes->setNodeMask(on ? ~0u : 0u);
}

void Stage::tense(bool on) {
    settings.tensed = false;
    for (const auto& skin : _figure.skins)
        for (const std::string& muscle : skin->getModel()->inputs())
            settings.tensed = skin->setActivation(muscle, on ? 1.0f : 0.0f) && on;
    if (_figure.body) _figure.body->tension = settings.tensed ? 1.0f : 0.0f;
}

void Stage::changeMorph(int step) {
    if (_morphs.empty()) return;
    _morph = (_morph + _morphs.size() + static_cast<std::size_t>(step + 1) - 1) % _morphs.size();
}

void Stage::weighMorph(float more) {
    if (_morphs.empty()) return;
    auto& [name, weight] = _morphs[_morph];
    weight = std::clamp(weight + more, 0.0f, 1.0f);
    osgSkin::setMorph(*_figure.root, name, weight);
}

/// The morph targets around the selected one, as many as a window has room for.
std::string Stage::morphList() const {
    constexpr std::size_t kLines = 30;
    const std::size_t first = std::min(_morph - std::min(_morph, kLines / 2),
                                       _morphs.size() - std::min(_morphs.size(), kLines));
    std::string text = _morphs.empty() ? "no morph targets" : "";
    for (std::size_t i = first; i < std::min(_morphs.size(), first + kLines); ++i) {
        char weight[16];
        std::snprintf(weight, sizeof weight, "%4.2f ", static_cast<double>(_morphs[i].second));
        text += std::string(i == _morph ? "> " : "   ") + weight + _morphs[i].first + "\n";
    }
    return text;
}

example::View Stage::view() const {
    return example::framed(_extent.box, osg::Vec3d(0.35, -0.95, 0.2), _aspect);
}

osg::Vec4 Stage::colourOf(std::size_t vertex) const {
    const osgSkin::Binding& binding = _figure.body->character.binding;
    if (settings.colours == Colours::Regions) return osgSkin::regionColor(binding.regions[vertex]);
    if (settings.colours == Colours::Own) return figures::kSkin;
    const osgSkin::Influence ratios = figures::influenceOf(binding, vertex, settings.joint);
    return figures::ratioColour(
        static_cast<double>(settings.colours == Colours::Bend ? ratios.bend : ratios.twist));
}

void Stage::updateFigure() {
    _study->removeChildren(0, _study->getNumChildren());
    _productShown = settings.method == Method::Ours && settings.colours == Colours::Own;
    const Timer::time_point start = Timer::now();
    if (_productShown) {
        for (const auto& skin : _figure.skins) skin->getDeformedGeometry();
        _skinTime = millisecondsSince(start);
        return;
    }
    const std::vector<glm::dvec3> posed = _figure.body->deform(settings.method, _bones->read());
    _skinTime = millisecondsSince(start);
    _study->addChild(
        figures::makeSkin(*_figure.body, posed, [this](std::size_t v) { return colourOf(v); }));
}

void Stage::updateSkeleton() {
    _lines->removeChildren(0, _lines->getNumChildren());
    if (!settings.skeleton) return;
    BoneLines bones;
    _figure.root->accept(bones);
    _lines->addChild(
        figures::makeLines(bones.lines, osg::Vec4(0.3f, 0.85f, 0.95f, 1), GL_LINES, 3.0f));
    _lines->addChild(figures::makeLines(bones.points, osg::Vec4(1, 1, 1, 1), GL_POINTS, 6.0f));
}

void Stage::updateBounds() {
    _boxes->removeChildren(0, _boxes->getNumChildren());
    if (!settings.bounds) return;
    for (const auto& skin : _figure.skins)
        for (const osg::NodePath& path : skin->getParentalNodePaths())
            _boxes->addChild(makeBox(skin->getBoundingBox(), osg::computeLocalToWorld(path)));
}

void Stage::update() {
    if (_lastFrame != Timer::time_point()) {
        const double last = millisecondsSince(_lastFrame);
        _frameTime = _frameTime > 0.0 ? 0.9 * _frameTime + 0.1 * last : last;
    }
    _lastFrame = Timer::now();

    updateFigure();
    updateSkeleton();
    updateBounds();
    const osg::ref_ptr<osg::PolygonMode> mode =
        new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK,
                             settings.wireframe ? osg::PolygonMode::LINE : osg::PolygonMode::FILL);
    _state->setAttribute(mode, osg::StateAttribute::OVERRIDE | osg::StateAttribute::ON);
    _help->setNodeMask(settings.help ? ~0u : 0u);
    _status->setNodeMask(settings.status ? ~0u : 0u);
    _morphList->setText(settings.morphs ? morphList() : "");
    std::string text = summary();
    text.replace(text.find("; "), 2, "\n");
    _status->setText(text + "\n" + times() + "; h: keys");
}

std::string Stage::times() const {
    char text[80];
    std::snprintf(text, sizeof text, "%.1f ms a frame, the skin %.3f ms", _frameTime, _skinTime);
    return text;
}

std::string Stage::summary() const {
    char time[160] = "at rest";
    if (motionCount() > 0)
        std::snprintf(time, sizeof time, "%s %.2f of %.2f s, %s x%g",
                      _figure.motion(_motion).getName().c_str(), clock.time(), clock.length(),
                      clock.playing ? "playing" : "paused", clock.speed);
    std::string text = std::string(time) + "; " + nameOf(settings.method);
    if (settings.colours == Colours::Regions) text += "; regions";
    if (settings.colours == Colours::Bend || settings.colours == Colours::Twist)
        text += std::string(settings.colours == Colours::Bend ? "; bend" : "; twist") +
                " ratios of " + _figure.body->character.binding.joints[settings.joint].name;
    if (settings.turnedNormals) text += "; normals rotated with vertices";
    if (settings.tensed) text += "; muscles tensed";
    if (!_morphs.empty() && _morphs[_morph].second > 0.0f) {
        char weight[16];
        std::snprintf(weight, sizeof weight, " %g", static_cast<double>(_morphs[_morph].second));
        text += "; " + _morphs[_morph].first + weight;
    }
    if (settings.skeleton) text += "; skeleton";
    if (settings.wireframe) text += "; wireframe";
    if (settings.bounds) text += "; bounds";
    return text;
}

} // namespace viewer
