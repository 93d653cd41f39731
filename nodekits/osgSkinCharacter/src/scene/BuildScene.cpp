// SPDX-License-Identifier: MIT
#include "scene/BuildScene.h"

#include "scene/FrontOrientation.h"
#include "source/CharacterSource.h"
#include "source/LoadReport.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/Binding>
#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>
#include <osgSkin/ShareEqualData>
#include <osgSkin/UpdateMorphs>
#include <osgSkinBind/Bind>
#include <osgSkinBind/NonUniformScale>
#include <osgSkinBind/ShowRegions>
#include <osgSkinCharacter/CharacterMotion>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinMotion/Constraints>
#include <osgSkinMotion/Prop>
#include <osgSkinMotion/SpringBones>
#include <osgSkinRig/BodyDirections>
#include <osgSkinRig/Clip>
#include <osgSkinRig/ForwardKinematics>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/Motion>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <osg/BoundingBox>
#include <osg/BoundingSphere>
#include <osg/ComputeBoundsVisitor>
#include <osg/FrameStamp>
#include <osg/Group>
#include <osg/Matrix>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osg/ref_ptr>
#include <osgAnimation/Channel>
#include <osgDB/FileNameUtils>
#include <osgDB/Options>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// For each joint, the largest distance of its region's skin from its centre.
std::vector<double> skinDistances(const Binding& binding, const SkinMesh& mesh) {
    std::vector<double> distances(binding.joints.size(), 0.0);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const std::uint32_t joint = binding.regions[v];
        distances[joint] = std::max(distances[joint],
                                    glm::length(mesh.positions[v] - binding.joints[joint].centre));
    }
    return distances;
}

/// A sphere around the character over the whole clip, in the scene: the joints' paths, enlarged by
/// the skin's distance from its joints.
osg::BoundingSphere clipBounds(const Clip& clip, const Character& character) {
    // A character moves less than a hand's breadth in a few samples.
    const std::size_t step = std::max<std::size_t>(1, clip.frames / 200);
    const RestSkeleton& rig = character.rest;
    std::vector<double> distances = skinDistances(character.binding, character.body.mesh);
    for (double& distance : distances) distance *= character.metresPerUnit();
    std::vector<std::pair<osg::Vec3d, double>> balls;
    osg::BoundingBoxd box;
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> centres;
    for (std::size_t frame = 0; frame < clip.frames; frame += step) {
        worldRotations(rig, &clip.rotations[frame * clip.joints], rotations);
        worldPositions(rig, rotations, clip.rootPositions[frame], centres);
        for (std::size_t j = 0; j < centres.size(); ++j) {
            const osg::Vec3d centre = toOsg(centres[j]) * character.toWorld;
            const osg::Vec3d reach(distances[j], distances[j], distances[j]);
            balls.emplace_back(centre, distances[j]);
            box.expandBy(centre - reach);
            box.expandBy(centre + reach);
        }
    }
    double radius = 0.0;
    for (const auto& [centre, distance] : balls)
        radius = std::max(radius, (centre - box.center()).length() + distance);
    return {box.center(), static_cast<float>(radius)};
}

/// The meshes of a character's props, in the character's unit. Each file is read once and shared.
class PropMeshes {
public:
    /// \param source its options are for the meshes, too
    /// \param metresPerUnit of rest space
    PropMeshes(const CharacterSource& source, double metresPerUnit)
        : _options(source.meshOptions), _metresPerUnit(metresPerUnit),
          _overridesFiles(source.options.unit && source.options.unit->overridesFile) {}

    /// \throw Error with the file and the place in it
    const ImportedMesh& of(const std::string& file);

private:
    /// Scales a mesh whose file states another unit than the character's.
    void scale(const std::string& file, const ImportedMesh& mesh) const;

    const osg::ref_ptr<const osgDB::Options> _options;
    const double _metresPerUnit;
    const bool _overridesFiles;
    std::map<std::string, ImportedMesh> _meshes; ///< by path
};

void PropMeshes::scale(const std::string& file, const ImportedMesh& mesh) const {
    const double stated = _overridesFiles ? 0.0 : importUnit(file, _options.get());
    if (stated == 0.0 || stated == _metresPerUnit) return;
    for (const MeshPart& part : mesh.parts) {
        for (osg::Vec3& v : static_cast<osg::Vec3Array&>(*part.geometry->getVertexArray()))
            v *= static_cast<float>(stated / _metresPerUnit);
        part.geometry->dirtyBound();
    }
}

const ImportedMesh& PropMeshes::of(const std::string& file) {
    std::error_code failure;
    const std::string path = std::filesystem::weakly_canonical(file, failure).string();
    const std::string& key = failure ? file : path;
    const auto known = _meshes.find(key);
    if (known != _meshes.end()) return known->second;
    const ImportedMesh& read = _meshes.emplace(key, importMesh(file, _options.get())).first->second;
    scale(file, read);
    return read;
}

/// The time that a motion skips, in seconds. A prop skips it too, to stay in time with the motion.
double skippedTime(const CharacterSource& source, const CharacterMotion& motion,
                   const SkinFile::Prop& prop) {
    for (const SkinFile::MotionEntry& entry : source.motions)
        if (entry.name == prop.motion) return double(entry.skipFrames) * motion.clip.frameTime;
    return 0.0;
}

/// The rest of a prop's path after some time. Its samples may have another rate than the motion's,
/// so that it begins between two of them. A prop that never moves has one sample, which is kept.
Motion after(const Motion& path, double seconds, const std::string& file) {
    if (seconds == 0.0 || path.frames == 1) return path;
    const double first = seconds / path.frameTime, last = double(path.frames - 1);
    if (first > last + 1e-6)
        throw Error(file + ": expected samples after the " + std::to_string(seconds) +
                    " s that its motion skips, found " + std::to_string(last * path.frameTime) +
                    " s");
    Motion rest = path;
    rest.frames = 0;
    rest.rotations.clear();
    rest.rootPositions.clear();
    rest.moves.clear(); // of joints that a prop does not follow
    for (double at = first; at <= last + 1e-6; at += 1.0) {
        const double whole = std::min(std::floor(at + 1e-6), last);
        const double part = at - whole < 1e-6 ? 0.0 : at - whole;
        const std::size_t from = static_cast<std::size_t>(whole);
        const std::size_t to = std::min(from + 1, path.frames - 1);
        std::vector<glm::dquat> rotations;
        for (std::size_t j = 0; j < path.skeleton.joints.size(); ++j)
            rotations.push_back(
                part == 0.0 ? path.rotation(from, j)
                            : glm::slerp(path.rotation(from, j), path.rotation(to, j), part));
        rest.addFrame(glm::mix(path.rootPositions[from], path.rootPositions[to], part), rotations);
    }
    return rest;
}

/// Adds the props of a motion, animated by further channels of its animation, so that they stay in
/// time with the figure. Their paths are transformed like the root's.
///
/// \param source names the props; counts their samples
/// \param motion that they belong to; retargeted
/// \param parent gets a child for each prop; in skeleton space
/// \param meshes of the props of all motions
/// \param options for the props' motions; may be null
/// \throw Error with the file and the place in it
void addProps(CharacterSource& source, const CharacterMotion& motion, osg::Group& parent,
              PropMeshes& meshes, const osgDB::Options* options) {
    for (std::size_t i = 0; i < source.props.size(); ++i) {
        const SkinFile::Prop& prop = source.props[i];
        if (prop.motion != motion.name()) continue;
        // Bones and props share one table of animation targets, so the name must not be a joint's.
        const std::string name = "prop:" + prop.motion + ":" + std::to_string(i);
        const ImportedMesh& mesh = meshes.of(prop.mesh);
        const Motion whole = importMotion(prop.file, 0, {}, options);
        const Motion path = after(whole, skippedTime(source, motion, prop), prop.file);
        if (path.skeleton.joints.size() > 1)
            OSG_NOTICE << onOneLine(prop.file + ": has " +
                                    std::to_string(path.skeleton.joints.size()) +
                                    " joints, of which a prop follows the first alone")
                       << std::endl;
        withFileContext(prop.file, [&] {
            source.samples.add(prop.file, whole.frames, path.skeleton.joints.size(), source.limits);
        });
        parent.addChild(makeProp(name, mesh.parts, path, motion.report, *motion.animation));
    }
}

constexpr int kSamples = 24;

void update(osg::Node& root, double time) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    root.accept(visitor);
}

} // namespace

void normalizeIfScaled(osg::MatrixTransform& transform) {
    const osg::Vec3d x = osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), transform.getMatrix());
    if (std::abs(x.length() - 1.0) > 1e-6)
        transform.getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON);
}

osg::BoundingSphere playedBounds(osg::Group& root, const osgAnimation::AnimationList& clips) {
    // A separate manager, so that the one that plays later begins at 0.
    double duration = 0.0;
    if (!clips.empty()) {
        const osg::ref_ptr<AutoPlayManager> manager = new AutoPlayManager;
        manager->registerAnimation(clips.front());
        root.setUpdateCallback(manager);
        manager->playAnimation(clips.front());
        duration = clips.front()->getDuration();
    }
    osg::BoundingBox box;
    for (int k = kSamples - 1; k >= 0; --k) { // the first pose last
        update(root, duration * k / kSamples);
        osg::ComputeBoundsVisitor bounds(osg::NodeVisitor::TRAVERSE_ACTIVE_CHILDREN);
        root.accept(bounds);
        box.expandBy(bounds.getBoundingBox());
        if (duration <= 0.0) break;
    }
    root.setUpdateCallback(nullptr);
    return box.valid() ? osg::BoundingSphere(box) : osg::BoundingSphere();
}

namespace {

void attach(const CharacterSource& source, Character& character) {
    const SkinMesh& mesh = character.body.mesh;
    std::vector<std::string> rigid;
    if (!source.options.mergeRigid)
        rigid = source.bind.rigid ? *source.bind.rigid
                                  : automaticRigidJoints(character.rest, source.bind.names);
    character.skeleton = source.skeleton ? source.skeleton : makeSkeleton(character.rest);
    character.skin = attachSkin(*character.skeleton, mesh, character.body.parts, character.binding,
                                splitRigid(mesh, character.binding, rigid));
}

osg::ref_ptr<osg::MatrixTransform> makeUpright(const Character& character) {
    osg::ref_ptr<osg::MatrixTransform> upright = new osg::MatrixTransform(character.toWorld);
    upright->setName("upright");
    normalizeIfScaled(*upright);
    // The bones below are set every frame: an optimizer must not flatten this transform into them.
    upright->setDataVariance(osg::Object::DYNAMIC);
    return upright;
}

/// Replaces the name of the bone that stands for the nodes above the topmost joint, which the file
/// does not have, in a line of findNonUniformScale().
std::string inUsersWords(const std::string& found) {
    const std::size_t end = found.find(kAboveRoot + std::string("\""));
    const std::size_t begin = found.find('"');
    if (end == std::string::npos || begin > end) return found;
    return "the armature or another object above joint " + found.substr(begin, end - begin) +
           "\" (apply its scale in the program that made the file)";
}

/// A rigged model's own animations, as the character's motions.
void takeAnimations(const CharacterSource& source, Character& character) {
    const std::vector<std::string> bones = findNonUniformScale(
        *character.skeleton, source.animations, character.binding, character.skin.skins);
    if (!bones.empty())
        warn(character.notes,
             character.file + ": " + inUsersWords(bones.front()) +
                 (bones.size() > 1 ? " and " + std::to_string(bones.size() - 1) + " more" : "") +
                 " scaled non-uniformly, mirrored or to nothing, which the skin does not follow");
    for (const auto& animation : source.animations)
        character.motions.emplace_back().animation = animation;
}

/// Whether some clip has channels of morph targets.
bool drivesMorphs(const std::vector<CharacterMotion>& motions) {
    for (const CharacterMotion& motion : motions)
        for (const auto& channel : motion.animation->getChannels())
            if (channel->getTargetName() == UpdateMorphs::kName) return true;
    return false;
}

void play(Character& character) {
    if (character.motions.empty()) return;
    osgAnimation::AnimationList clips;
    for (const CharacterMotion& motion : character.motions) clips.push_back(motion.animation);
    shareEqualKeys(clips);
    const osg::ref_ptr<AutoPlayManager> manager =
        new AutoPlayManager; // plays again when saved and read
    manager->registerAnimations(clips);
    character.manager = manager;
    character.root->setUpdateCallback(character.manager);
    character.manager->playAnimation(character.motions.front().animation);
}

/// For a rig that is not straight at rest (sitting or curled up) the motion may show which axis is
/// up.
osg::Matrixd frontRotation(const Character& character, const JointRoles& roles) {
    const JointCentres atRest = restCentres(character.rest, character.toWorld);
    if (character.motions.empty() || BodyDirections(roles, atRest).isStraight())
        return orientToFront(roles, atRest);
    return orientToFront(
        roles, atRest,
        clipCentres(character.rest, character.motions.front().clip, character.toWorld));
}

/// Leaves out what files say of joints that the skeleton lacks.
void dropUnknownJoints(CharacterSource& source, Character& character) {
    const osgAnimation::BoneMap bones = bonesOf(*character.skeleton);
    std::size_t dropped = 0;
    const auto isUnknown = [&](const std::string& joint) {
        if (bones.count(joint) != 0) return false;
        ++dropped;
        return true;
    };
    const auto drop = [](auto& list, const auto& isDropped) {
        list.erase(std::remove_if(list.begin(), list.end(), isDropped), list.end());
    };
    drop(source.constraints, [&](const Constraint& each) {
        return isUnknown(each.joint.name) || isUnknown(each.source.name);
    });
    for (SpringSettings::Chain& chain : source.springs.chains) {
        if (!chain.centre.empty() && isUnknown(chain.centre)) chain.centre.clear();
        drop(chain.joints,
             [&](const SpringSettings::Joint& joint) { return isUnknown(joint.name); });
    }
    for (SpringSettings::Collider& collider : source.springs.colliders)
        if (isUnknown(collider.joint)) collider.joint.clear();
    if (dropped > 0)
        warn(character.notes, character.file + ": " + std::to_string(dropped) +
                                  " joints of constraints and springs are not in the skeleton; "
                                  "left out");
}

} // namespace

void buildScene(CharacterSource& source, const LoadOptions& options, Character& character) {
    if (options.showRegions) showRegions(character.body.parts, character.binding);
    attach(source, character);
    character.roles = recogniseJoints(character.rest, source.bind.names);
    const JointRoles& roles = character.roles;
    if (!source.skeleton) character.toWorld = character.toWorld * frontRotation(character, roles);
    const osg::ref_ptr<osg::MatrixTransform> upright = makeUpright(character);
    upright->addChild(character.skeleton);
    PropMeshes propMeshes(source, character.metresPerUnit());
    for (const CharacterMotion& motion : character.motions)
        addProps(source, motion, *upright, propMeshes, options.readOptions.get());
    character.root = new osg::Group;
    character.root->setName(osgDB::getStrippedName(character.file));
    character.root->addChild(upright);
    if (source.skeleton) takeAnimations(source, character);
    if (drivesMorphs(character.motions)) upright->setUpdateCallback(new UpdateMorphs);
    if (source.skeleton) {
        const JointCentres atRest = boneCentres(character.rest, *character.root);
        osg::BoundingSphere bound = playedBounds(*character.root, source.animations);
        const JointCentres played = boneCentres(character.rest, *character.root);
        const osg::Matrixd rotation = orientToFront(roles, atRest, played);
        character.toWorld = character.toWorld * rotation;
        upright->setMatrix(character.toWorld);
        bound.center() = bound.center() * rotation;
        character.root->setInitialBound(bound);
    } else if (!character.motions.empty()) {
        // A viewer places its camera before the first frame, so it needs bounds of the whole
        // motion.
        character.root->setInitialBound(clipBounds(character.motions.front().clip, character));
        character.pose(character.motions.front(), 0);
    }
    play(character);
    if (character.skeleton && (!source.constraints.empty() || !source.springs.chains.empty()))
        dropUnknownJoints(source, character);
    if (!source.constraints.empty()) attach<Constraints>(*character.root, source.constraints);
    if (!source.springs.chains.empty() && source.options.springs.value_or(true))
        attach<SpringBones>(*character.root, source.springs);
}

} // namespace osgSkin
