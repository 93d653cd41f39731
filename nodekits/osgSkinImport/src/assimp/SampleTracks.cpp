// SPDX-License-Identifier: MIT
#include "assimp/SampleTracks.h"

#include "assimp/AssimpScene.h"
#include "motion/RootMotion.h"
#include "text/FileText.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace osgSkin {
namespace {

struct Grid {
    double first = std::numeric_limits<double>::infinity();
    double last = -std::numeric_limits<double>::infinity();
    std::size_t samples = 0;

    template <typename Key>
    void include(const Key* keys, unsigned count) {
        if (count == 0) return;
        first = std::min(first, keys[0].mTime);
        last = std::max(last, keys[count - 1].mTime);
        samples = std::max(samples, static_cast<std::size_t>(count));
    }

    double time(std::size_t sample) const {
        if (samples < 2) return first;
        return first +
               (last - first) * static_cast<double>(sample) / static_cast<double>(samples - 1);
    }
};

glm::dquat blend(const glm::dquat& a, const glm::dquat& b, double t) {
    return glm::slerp(a, b, t);
}
glm::dvec3 blend(const glm::dvec3& a, const glm::dvec3& b, double t) {
    return glm::mix(a, b, t);
}

/// The track's value at `time`: a key's own value where one stands there.
template <typename Key>
auto valueAt(const Key* keys, unsigned count, double time) {
    const Key* next = std::lower_bound(keys, keys + count, time,
                                       [](const Key& key, double t) { return key.mTime < t; });
    if (next == keys + count) return toGlm(keys[count - 1].mValue);
    if (next == keys || next->mTime == time) return toGlm(next->mValue);
    const Key* before = next - 1;
    const double fraction = (time - before->mTime) / (next->mTime - before->mTime);
    return blend(toGlm(before->mValue), toGlm(next->mValue), fraction);
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

/// For each joint, whether its track moves it from the position that its node has.
std::vector<bool> findMovedJoints(const std::vector<const aiNodeAnim*>& tracks,
                                  const SceneSkeleton& skeleton) {
    std::vector<bool> result(tracks.size(), false);
    for (std::size_t j = 0; j < tracks.size(); ++j) {
        if (tracks[j] == nullptr) continue;
        const glm::dvec3 rest(toGlm(skeleton.nodes[j]->mTransformation)[3]);
        const aiVectorKey* const keys = tracks[j]->mPositionKeys;
        result[j] =
            std::any_of(keys, keys + tracks[j]->mNumPositionKeys,
                        [&](const aiVectorKey& key) { return isMoved(toGlm(key.mValue), rest); });
    }
    return result;
}

glm::dquat localRotation(const aiNodeAnim* track, const aiNode& node, double time) {
    if (track == nullptr || track->mNumRotationKeys == 0)
        return rotationOf(toGlm(node.mTransformation));
    return glm::normalize(valueAt(track->mRotationKeys, track->mNumRotationKeys, time));
}

glm::dvec3 localPosition(const aiNodeAnim* track, const aiNode& node, double time) {
    if (track == nullptr || track->mNumPositionKeys == 0)
        return glm::dvec3(toGlm(node.mTransformation)[3]);
    return valueAt(track->mPositionKeys, track->mNumPositionKeys, time);
}

/// A node's matrix as its track has it, with the scale that the node has.
glm::dmat4 localMatrix(const aiNodeAnim* track, const aiNode& node, double time) {
    const glm::dmat4 own = toGlm(node.mTransformation);
    glm::dmat4 result = glm::mat4_cast(localRotation(track, node, time));
    for (int axis = 0; axis < 3; ++axis) result[axis] *= glm::length(glm::dvec3(own[axis]));
    result[3] = glm::dvec4(localPosition(track, node, time), 1.0);
    return result;
}

} // namespace

Motion sampleTracks(const aiAnimation& animation, const SceneSkeleton& skeleton,
                    const std::string& path) {
    const std::vector<const aiNodeAnim*> tracks = tracksOf(animation, skeleton);
    Grid grid;
    for (const aiNodeAnim* track : tracks) {
        if (track == nullptr) continue;
        grid.include(track->mRotationKeys, track->mNumRotationKeys);
        grid.include(track->mPositionKeys, track->mNumPositionKeys);
    }
    if (grid.samples == 0) failFile(path, "no key in its animation, expected at least one");
    const double rate = animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 25.0;

    Motion motion;
    const std::vector<bool> moved = findMovedJoints(tracks, skeleton);
    const std::size_t root = rootMotionJoint(skeleton.rest, moved);
    motion.skeleton = skeletonFrom(skeleton.rest, root);
    motion.frames = grid.samples;
    motion.frameTime = 1.0 / rate;
    if (grid.samples > 1)
        motion.frameTime = (grid.last - grid.first) / rate / static_cast<double>(grid.samples - 1);
    if (!std::isfinite(motion.frameTime) || !(motion.frameTime > 0.0))
        failFile(path, "the time between its samples is not positive");
    noticeUnusedMoves(skeleton.rest, moved, root, path);

    const std::size_t joints = tracks.size();
    const glm::dquat aboveRotation = rotationOf(skeleton.aboveRoot);
    std::vector<glm::dquat> world(joints);   // the nodes' own frames
    std::vector<glm::dquat> aligned(joints); // the same, as rotations from rest
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const double time = grid.time(f);
        for (std::size_t j = 0; j < joints; ++j) {
            const int up = skeleton.rest.joints[j].parent;
            const auto p = static_cast<std::size_t>(std::max(up, 0));
            world[j] = (up < 0 ? aboveRotation : world[p]) *
                       localRotation(tracks[j], *skeleton.nodes[j], time);
            aligned[j] = world[j] * glm::conjugate(skeleton.worldRotations[j]);
            if (j >= root)
                motion.rotations.push_back(glm::normalize(
                    j == root ? aligned[j] : glm::conjugate(aligned[p]) * aligned[j]));
        }
        glm::dvec3 position = skeleton.rest.joints[0].centre;
        if (root > 0 || (tracks[0] != nullptr && tracks[0]->mNumPositionKeys > 0)) {
            glm::dmat4 above = skeleton.aboveRoot;
            for (std::size_t j = 0; j < root; ++j)
                above *= localMatrix(tracks[j], *skeleton.nodes[j], time);
            position = glm::dvec3(
                above * glm::dvec4(localPosition(tracks[root], *skeleton.nodes[root], time), 1.0));
        }
        motion.rootPositions.push_back(position);
    }
    return motion;
}

} // namespace osgSkin
