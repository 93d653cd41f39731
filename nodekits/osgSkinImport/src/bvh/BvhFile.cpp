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

BvhFile readBvh(const std::string& path) {
    const std::string text = readText(path);
    BvhTokens words(path, text);
    BvhFile file;
    readBvhHierarchy(words, file);
    readBvhFrames(words, path, file);
    return file;
}

} // namespace osgSkin
