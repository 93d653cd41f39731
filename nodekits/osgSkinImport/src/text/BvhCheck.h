// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace osgSkin {

/// What a BVH file declares about its samples.
struct BvhSummary {
    double frameTime = 0.0; ///< seconds, positive
    std::size_t frames = 0; ///< may be 0
};

/// Checks the structure of a BVH file before Assimp parses it.
///
/// Assimp trusts the declared number of frames (and allocates for it), recurses once a joint, reads
/// "nan", and ignores position channels unless a joint has six channels. None of that gets past
/// here. \throw osgSkin::Error "PATH: line N: what was expected".
BvhSummary checkBvh(const std::string& path, const std::string& text);

} // namespace osgSkin
