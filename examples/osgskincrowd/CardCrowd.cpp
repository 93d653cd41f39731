// SPDX-License-Identifier: MIT
#include "CardCrowd.h"

#include <osgSkin/RigidPart>
#include <osgSkinGpu/CrowdCharacter>
#include <osgSkinImport/ReadScene>
#include <osgSkinRig/ClipCharacter>

#include <osg/FrameStamp>
#include <osg/NodeCallback>
#include <osg/NodeVisitor>
#include <osg/ref_ptr>
#include <osgDB/Registry>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr double kSamplesASecond = 60.0;

/// Finds the skins and rigid parts of a scene, with their node paths.
class FindDrawn : public osg::NodeVisitor {
public:
    FindDrawn() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        const osg::NodePath& path = getNodePath();
        const bool isSkin = dynamic_cast<osgSkin::DeformableSkin*>(&drawable) != nullptr;
        const bool isRigid = std::any_of(path.begin(), path.end(), [](const osg::Node* node) {
            return dynamic_cast<const osgSkin::RigidPart*>(node) != nullptr;
        });
        if (isRigid && (isSkin || drawable.asGeometry() != nullptr)) rigids.push_back(path);
        if (!isRigid && isSkin) skins.push_back(path);
    }

    std::vector<osg::NodePath> skins, rigids;
};

template <typename Node>
Node* nearest(const osg::NodePath& path) {
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (auto* found = dynamic_cast<Node*>(*node)) return found;
    return nullptr;
}

/// Reads a character, bakes its first clip for the graphics card, and adds three coarser levels of
/// detail.
///
/// \param file a character's file
/// \param seconds set to the clip's length
/// \throw std::runtime_error if the file cannot be read, or has no skin
osg::ref_ptr<osgSkin::CrowdCharacter> readCardCharacter(const std::string& file, double& seconds) {
    const osg::ref_ptr<osg::Node> scene =
        osgSkin::readScene(file, osgDB::Registry::instance()->getOptions());
    FindDrawn found;
    scene->accept(found);
    if (found.skins.empty())
        throw std::runtime_error(file + ": expected a character with a deformable skin");
    osg::ref_ptr<osgSkin::CrowdCharacter> character = new osgSkin::CrowdCharacter;
    std::vector<osg::ref_ptr<osgSkin::DeformableSkin>> skins;
    for (const osg::NodePath& path : found.skins) {
        skins.emplace_back(static_cast<osgSkin::DeformableSkin*>(path.back()));
        character->addSkin(*skins.back(), osg::computeLocalToWorld(path));
    }
    for (const osg::NodePath& path : found.rigids)
        if (const auto* bone = nearest<osgAnimation::Bone>(path)) {
            const osg::Node& above = *path[path.size() - 2];
            osg::StateSet* state = path.back()->getStateSet();
            if (!state) state = const_cast<osg::StateSet*>(above.getStateSet());
            // One with morph targets is a skin.
            const auto* skin = dynamic_cast<const osgSkin::DeformableSkin*>(path.back());
            const osg::Geometry& geometry =
                skin ? *skin->getRestGeometry() : *path.back()->asGeometry();
            character->addRigid(geometry, state, 0, bone->getName());
        }

    // A player poses the scene's own skins instead of their bones.
    const auto source = osgSkin::ClipCharacter::create(*scene);
    osg::ref_ptr<const osgSkin::SampledClip> clip;
    if (!source->animations().empty())
        clip = source->sample(*source->animations().front(), kSamplesASecond);
    const osg::ref_ptr<osgSkin::ClipPlayer> player = new osgSkin::ClipPlayer;
    for (const auto& skin : skins) player->addSkin(skin);
    osgSkin::CrowdCharacter::Samples samples(skins.size());
    const std::size_t count = clip ? clip->sampleCount() : 1;
    for (std::size_t i = 0; i < count; ++i) {
        if (clip) player->setLayer(0, {clip, double(i) * clip->step()});
        if (clip && !player->pose()) throw std::runtime_error(file + ": its clip poses no skin");
        for (std::size_t s = 0; s < skins.size(); ++s)
            samples[s].push_back(skins[s]->getPose().skinning());
    }
    seconds = clip ? clip->duration() : 0.0;
    character->addClip(samples, clip ? 1.0 / clip->step() : kSamplesASecond, true);
    // For figures of 1/4, 1/10 and 1/25 of the picture's height.
    character->addLevel(0.4, 0.25);
    character->addLevel(0.15, 0.1);
    character->addLevel(0.05, 0.04);
    return character;
}

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

} // namespace

/// Measures a traversal. Stores a reference, because the crowd owns the scene that owns this.
class CardCrowd::Timed : public osg::NodeCallback {
public:
    using Step = std::function<void(double)>; ///< argument: simulation time in seconds

    Timed(double& milliseconds, Step first)
        : _milliseconds(milliseconds), _first(std::move(first)) {}
    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        const auto start = Clock::now();
        const bool timed = nv && nv->getFrameStamp();
        if (_first) _first(timed ? nv->getFrameStamp()->getSimulationTime() : 0.0);
        traverse(node, nv);
        _milliseconds = millisecondsSince(start);
    }

private:
    double& _milliseconds;
    Step _first;
};

CardCrowd::CardCrowd(const std::vector<std::string>& files, std::size_t count)
    : _scene(new osg::Group) {
    std::vector<double> seconds(files.size());
    float width = 0.0f;
    for (std::size_t i = 0; i < files.size(); ++i) {
        _characters.push_back(readCardCharacter(files[i], seconds[i]));
        const osg::BoundingBox& box = _characters.back()->bounds();
        width = std::max({width, box.xMax() - box.xMin(), box.yMax() - box.yMin()});
    }
    width *= 0.7f; // their arms may overlap
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    _radius = 0.5f * width * static_cast<float>(side);
    std::vector<std::vector<osgSkin::CrowdInstance>> members(files.size());
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t line = i / side, kind = i % files.size();
        const double row = static_cast<double>(line) - 0.5 * static_cast<double>(side);
        const double column = static_cast<double>(i % side) + (line % 2 == 0 ? 0.0 : 0.5) -
                              0.5 * static_cast<double>(side);
        osgSkin::CrowdInstance member;
        member.position = osg::Vec3d(column, row, 0.0) * static_cast<double>(width);
        member.phase = std::fmod(0.617 * static_cast<double>(i), 1.0) * seconds[kind];
        member.speed = 0.9f + 0.02f * static_cast<float>(i % 11);
        const float shade = 0.7f + 0.03f * static_cast<float>(i % 10);
        member.colour = osg::Vec4(shade, 0.9f * shade, 1.0f - 0.3f * shade, 1.0f);
        members[kind].push_back(member);
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        _crowds.push_back(new osgSkin::GpuCrowd(_characters[i]));
        _crowds.back()->setInstances(members[i]);
        _scene->addChild(_crowds.back());
    }
    _scene->setUpdateCallback(new Timed(_updateTime, [this](double time) {
        for (const osg::ref_ptr<osgSkin::GpuCrowd>& crowd : _crowds) crowd->setTime(time);
    }));
    _scene->setCullCallback(new Timed(_cullTime, {}));
}

CardCrowd::~CardCrowd() {
    _scene->setUpdateCallback(nullptr);
    _scene->setCullCallback(nullptr);
}

std::string CardCrowd::summary() const {
    std::ostringstream out;
    for (std::size_t i = 0; i < _crowds.size(); ++i) {
        const osgSkin::CrowdCharacter& character = *_characters[i];
        std::size_t vertices = 0;
        for (const osgSkin::CrowdCharacter::Part& part : character.parts())
            vertices += part.rest->getVertexArray()->getNumElements();
        out << (i > 0 ? "; " : "") << _crowds[i]->getInstanceCount() << " members of " << vertices
            << " vertices, triangles";
        for (std::size_t level = 0; level < character.levelCount(); ++level)
            out << ' ' << character.triangleCount(level);
    }
    out << "; " << osgSkin::CrowdInstance::kTexels * 16 << " bytes a member";
    return out.str();
}
