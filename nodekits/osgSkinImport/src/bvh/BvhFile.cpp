// SPDX-License-Identifier: MIT
#include "bvh/BvhFile.h"

#include "bvh/BvhFrames.h"
#include "bvh/BvhHierarchy.h"
#include "bvh/BvhTokens.h"
#include "text/FileText.h"

#include <algorithm>

namespace osgSkin {

bool BvhJoint::hasPosition() const {
    return std::any_of(channels.begin(), channels.end(),
                       [](const BvhChannel& channel) { return !channel.isRotation; });
}

BvhFile readBvh(const std::string& path, const ReadLimits& limits) {
    const std::string text = readText(path, limits);
    BvhTokens words(path, text);
    BvhFile file;
    readBvhHierarchy(words, limits, file);
    readBvhFrames(words, path, file);
    // A joint without channels takes memory in every frame, and no byte of the file.
    const std::size_t most = limits.samplesOf(text.size());
    if (file.frames > most / file.joints.size())
        failFile(path, std::to_string(file.frames) + " frames of " +
                           std::to_string(file.joints.size()) + " joints, expected at most " +
                           std::to_string(most) + " rotations (option maxSamples)");
    return file;
}

} // namespace osgSkin
