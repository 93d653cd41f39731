// SPDX-License-Identifier: MIT
#include "assimp/mesh/AnimatedAttachments.h"

#include <assimp/scene.h>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr float kSame = 1e-3f; ///< of a length, or of a rotation's numbers

bool isOther(const aiVector3D& a, const aiVector3D& b) {
    return (a - b).Length() > kSame * std::max(a.Length(), b.Length());
}

/// A rotation and its negative are the same.
bool isOther(aiQuaternion a, aiQuaternion b) {
    a.Normalize();
    b.Normalize();
    const float sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0.0f ? -1.0f : 1.0f;
    return std::max({std::abs(a.w - sign * b.w), std::abs(a.x - sign * b.x),
                     std::abs(a.y - sign * b.y), std::abs(a.z - sign * b.z)}) > kSame;
}

template <typename Key, typename Value>
bool anyOther(const Key* keys, unsigned count, const Value& rest) {
    return std::any_of(keys, keys + count,
                       [&rest](const Key& key) { return isOther(key.mValue, rest); });
}

bool moves(const aiNodeAnim& track, const aiNode& node) {
    aiVector3D scale, position;
    aiQuaternion rotation;
    node.mTransformation.Decompose(scale, rotation, position);
    return anyOther(track.mPositionKeys, track.mNumPositionKeys, position) ||
           anyOther(track.mRotationKeys, track.mNumRotationKeys, rotation) ||
           anyOther(track.mScalingKeys, track.mNumScalingKeys, scale);
}

} // namespace

std::set<const aiNode*> movedNodes(const aiScene& scene, const SceneBind& bind) {
    std::set<const aiNode*> result;
    for (unsigned a = 0; a < scene.mNumAnimations; ++a)
        for (unsigned c = 0; c < scene.mAnimations[a]->mNumChannels; ++c) {
            const aiNodeAnim& track = *scene.mAnimations[a]->mChannels[c];
            const aiNode* const node = bind.find(track.mNodeName.C_Str());
            if (node != nullptr && moves(track, *node)) result.insert(node);
        }
    return result;
}

} // namespace osgSkin
