// SPDX-License-Identifier: MIT
#include "rig/SampleTracks.h"

#include "assimp/AssimpScene.h"
#include "motion/RootMotion.h"
#include "rig/ReflectedRotation.h"
#include "rig/RigBones.h"
#include "rig/SampleGrid.h"
#include "text/FileText.h"

#include <osgSkin/GlmOsg>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <osg/BoundingBox>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace osgSkin {
namespace {

/// The times of a track's keys, in seconds. A single key holds its value at all times, and Assimp
/// adds some at 0.
template <typename Key>
void addTimes(const Key* keys, unsigned count, double rate, std::vector<double>& times) {
    if (count < 2) return;
    for (unsigned k = 0; k < count; ++k)
        if (std::isfinite(keys[k].mTime)) times.push_back(keys[k].mTime / rate);
}

glm::dquat blend(const glm::dquat& a, const glm::dquat& b, double t) {
    return glm::slerp(a, b, t);
}
glm::dvec3 blend(const glm::dvec3& a, const glm::dvec3& b, double t) {
    return glm::mix(a, b, t);
}

/// A sample's time, in ticks, and how far around it a key counts as standing there.
struct Moment {
    double time, reach;
};

/// The track's value: a key's own where one stands there.
template <typename Key>
auto valueAt(const Key* keys, unsigned count, const Moment& moment) {
    const double time = moment.time;
    const Key* next = std::lower_bound(keys, keys + count, time,
                                       [](const Key& key, double t) { return key.mTime < t; });
    if (next == keys + count) return toGlm(keys[count - 1].mValue);
    if (next == keys) return toGlm(next->mValue);
    const Key* before = next - 1;
    const double since = time - before->mTime, until = next->mTime - time;
    if (std::min(since, until) <= moment.reach)
        return toGlm(since < until ? before->mValue : next->mValue);
    return blend(toGlm(before->mValue), toGlm(next->mValue), since / (since + until));
}

std::vector<const aiNodeAnim*> tracksOf(const aiAnimation& animation,
                                        const SceneSkeleton& skeleton) {
    std::map<std::string, const aiNodeAnim*> byName;
    for (unsigned c = 0; c < animation.mNumChannels; ++c)
        byName.emplace(animation.mChannels[c]->mNodeName.C_Str(), animation.mChannels[c]);
    std::vector<const aiNodeAnim*> result;
    for (const RestJoint& joint : skeleton.rest.joints) {
        const auto found = byName.find(joint.name);
        result.push_back(found == byName.end() ? nullptr : found->second);
    }
    return result;
}

/// What makes a figure two units high or long, of a skeleton.
double unitScale(const RestSkeleton& rest) {
    osg::BoundingBoxd box;
    for (const RestJoint& joint : rest.joints) box.expandBy(toOsg(joint.centre));
    return box.radius() > 0.0 ? 1.0 / box.radius() : 1.0;
}

/// For each joint, whether its track moves it from the position that its node has: in the size that
/// a figure has, since nodes may count in other units than the scene.
std::vector<bool> findMovedJoints(const std::vector<const aiNodeAnim*>& tracks,
                                  const SceneSkeleton& skeleton) {
    std::vector<bool> result(tracks.size(), false);
    const double figure = unitScale(skeleton.rest);
    for (std::size_t j = 0; j < tracks.size(); ++j) {
        if (tracks[j] == nullptr) continue;
        const int up = skeleton.rest.joints[j].parent;
        const glm::dmat4& above =
            up < 0 ? skeleton.aboveRoot : skeleton.bind[static_cast<std::size_t>(up)];
        const double unit = figure * std::cbrt(std::abs(glm::determinant(glm::dmat3(above))));
        const glm::dvec3 rest = unit * glm::dvec3(toGlm(skeleton.nodes[j]->mTransformation)[3]);
        const aiVectorKey* const keys = tracks[j]->mPositionKeys;
        result[j] =
            std::any_of(keys, keys + tracks[j]->mNumPositionKeys, [&](const aiVectorKey& key) {
                return isMoved(unit * toGlm(key.mValue), rest);
            });
    }
    return result;
}

/// Tells of a joint whose track scales it: motions have no scale.
void noticeScales(const std::vector<const aiNodeAnim*>& tracks, const SceneSkeleton& skeleton,
                  const std::string& path) {
    constexpr double kSame = 0.01;
    for (std::size_t j = 0; j < tracks.size(); ++j) {
        if (tracks[j] == nullptr) continue;
        const glm::dvec3 rest = decompose(toGlm(skeleton.nodes[j]->mTransformation)).scale;
        const aiVectorKey* const keys = tracks[j]->mScalingKeys;
        const auto isOther = [&](const aiVectorKey& key) {
            const glm::dvec3 off = glm::abs(toGlm(key.mValue)) - glm::abs(rest);
            return glm::length(off) > kSame * glm::length(rest);
        };
        if (!std::any_of(keys, keys + tracks[j]->mNumScalingKeys, isOther)) continue;
        tellOf(path, "joint " + inQuotes(skeleton.rest.joints[j].name) +
                         " is scaled, which motions are read without");
        return;
    }
}

glm::dquat localRotation(const aiNodeAnim* track, const aiNode& node, const Moment& moment) {
    if (track == nullptr || track->mNumRotationKeys == 0)
        return decompose(toGlm(node.mTransformation)).rotation;
    return glm::normalize(valueAt(track->mRotationKeys, track->mNumRotationKeys, moment));
}

glm::dvec3 localPosition(const aiNodeAnim* track, const aiNode& node, const Moment& moment) {
    if (track == nullptr || track->mNumPositionKeys == 0)
        return glm::dvec3(toGlm(node.mTransformation)[3]);
    return valueAt(track->mPositionKeys, track->mNumPositionKeys, moment);
}

/// The scale that a node has beside localRotation(), with its signs.
glm::dvec3 localScale(const aiNodeAnim* track, const aiNode& node) {
    glm::dvec3 result = decompose(toGlm(node.mTransformation)).scale;
    if (track == nullptr || track->mNumRotationKeys == 0 || track->mNumScalingKeys == 0)
        return result;
    const glm::dvec3 told = toGlm(track->mScalingKeys[0].mValue);
    for (int axis = 0; axis < 3; ++axis) result[axis] = std::copysign(result[axis], told[axis]);
    return result;
}

/// A node's matrix as its track has it, with the scale that the node has.
glm::dmat4 localMatrix(const aiNodeAnim* track, const aiNode& node, const Moment& moment) {
    const glm::dvec3 scale = localScale(track, node);
    glm::dmat4 result = glm::mat4_cast(localRotation(track, node, moment));
    for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
    result[3] = glm::dvec4(localPosition(track, node, moment), 1.0);
    return result;
}

} // namespace

Motion sampleTracks(const aiAnimation& animation, const SceneSkeleton& skeleton,
                    std::size_t mostSamples, const std::string& path) {
    const std::vector<const aiNodeAnim*> tracks = tracksOf(animation, skeleton);
    const double rate = animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 25.0;
    std::vector<double> times;
    bool any = false;
    for (const aiNodeAnim* track : tracks) {
        if (track == nullptr) continue;
        addTimes(track->mRotationKeys, track->mNumRotationKeys, rate, times);
        addTimes(track->mPositionKeys, track->mNumPositionKeys, rate, times);
        any = any || track->mNumRotationKeys > 0 || track->mNumPositionKeys > 0;
    }
    if (times.empty() && any) times.push_back(0.0); // a pose
    if (times.empty()) failFile(path, "no key in its animation, expected at least one");
    const SampleGrid grid(std::move(times));
    if (!(static_cast<double>(grid.samples()) * static_cast<double>(tracks.size()) <=
          static_cast<double>(mostSamples)))
        failFile(path, "its animation lasts " +
                           std::to_string(grid.step() * double(grid.samples())) + " s, " +
                           std::to_string(grid.samples()) + " frames of " +
                           std::to_string(tracks.size()) + " joints, expected at most " +
                           std::to_string(mostSamples) + " rotations (option maxSamples)");

    Motion motion;
    const std::vector<bool> moved = findMovedJoints(tracks, skeleton);
    const std::size_t root = rootMotionJoint(skeleton.rest, moved);
    ReducedSkeleton carried(skeleton.rest, root);
    motion.skeleton = std::move(carried.rest);
    motion.frames = grid.samples();
    motion.frameTime = grid.samples() > 1 ? grid.step() : 1.0 / rate;
    if (!std::isfinite(motion.frameTime) || !(motion.frameTime > 0.0))
        failFile(path, "the time between its samples is not positive");
    noticeUnusedMoves(skeleton.rest, moved, carried, path);
    noticeScales(tracks, skeleton, path);

    const std::size_t joints = tracks.size();
    const ReflectedRotation aboveRoot{rotationOf(skeleton.aboveRoot),
                                      glm::determinant(glm::dmat3(skeleton.aboveRoot)) < 0.0};
    std::vector<ReflectedRotation> world(joints); // the nodes' own frames
    std::vector<glm::dquat> aligned(joints);      // the same, as rotations from rest
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const Moment moment{grid.time(f) * rate, 0.5001 * grid.step() * rate};
        for (std::size_t j = 0; j < joints; ++j) {
            const int up = skeleton.rest.joints[j].parent;
            const auto p = static_cast<std::size_t>(std::max(up, 0));
            world[j] = (up < 0 ? aboveRoot : world[p])
                           .below(localRotation(tracks[j], *skeleton.nodes[j], moment),
                                  localScale(tracks[j], *skeleton.nodes[j]));
            aligned[j] = world[j].rotation * glm::conjugate(skeleton.worldRotations[j]);
        }
        for (std::size_t k = 0; k < carried.joints.size(); ++k) {
            const glm::dquat& own = aligned[carried.joints[k]];
            const int up = motion.skeleton.joints[k].parent;
            motion.rotations.push_back(glm::normalize(
                up < 0
                    ? own
                    : glm::conjugate(aligned[carried.joints[static_cast<std::size_t>(up)]]) * own));
        }
        glm::dvec3 position = skeleton.rest.joints[0].centre;
        if (root > 0 || (tracks[0] != nullptr && tracks[0]->mNumPositionKeys > 0)) {
            glm::dmat4 above = skeleton.aboveRoot;
            for (const std::size_t j : carried.above)
                above *= localMatrix(tracks[j], *skeleton.nodes[j], moment);
            position = glm::dvec3(
                above *
                glm::dvec4(localPosition(tracks[root], *skeleton.nodes[root], moment), 1.0));
        }
        motion.rootPositions.push_back(position);
    }
    return motion;
}

} // namespace osgSkin
