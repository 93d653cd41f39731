// SPDX-License-Identifier: MIT
#include "rig/TrackOffsets.h"

#include <algorithm>

namespace osgSkin {

void takeTrackOffsets(const aiAnimation& animation, aiNode& root) {
    for (unsigned c = 0; c < animation.mNumChannels; ++c) {
        const aiNodeAnim& track = *animation.mChannels[c];
        if (track.mNumPositionKeys == 0) continue;
        aiNode* const node = root.FindNode(track.mNodeName);
        if (node == nullptr || node->mParent == nullptr) continue;
        aiMatrix4x4& matrix = node->mTransformation;
        if (matrix.a4 != 0.0f || matrix.b4 != 0.0f || matrix.c4 != 0.0f) continue;
        const aiVector3D& first = track.mPositionKeys[0].mValue;
        const auto isElsewhere = [&first](const aiVectorKey& key) {
            return (key.mValue - first).Length() > 1e-3f * first.Length();
        };
        const aiVectorKey* const keys = track.mPositionKeys;
        if (std::any_of(keys, keys + track.mNumPositionKeys, isElsewhere)) continue; // it moves
        matrix.a4 = first.x;
        matrix.b4 = first.y;
        matrix.c4 = first.z;
    }
}

} // namespace osgSkin
