// SPDX-License-Identifier: MIT
#pragma once

#include "LinearSkin.h"

#include <osgSkin/Pose>
#include <osgSkinCharacter/Character>

#include <cstddef>
#include <string>
#include <vector>

namespace bake {

/// A clip of a rigged file, sampled.
struct RiggedClip {
    std::string name;
    double seconds = 0.0;                   ///< between two samples
    std::vector<osgSkin::Pose> poses;       ///< with the inputs of correctives
    std::vector<std::vector<float>> morphs; ///< of each pose, the weights of Character::morphs()
};

/// The clip of helpers in files without other clips: jointRanges().
constexpr const char* kRangesClip = "joint ranges";

/// The contents of a rigged file in numbers.
struct RiggedReport {
    std::size_t joints = 0, helpers = 0, morphs = 0, correctives = 0; ///< numbers of them
    double worst = 0.0;                                               ///< LinearSkin::worst
    bool hasRanges = false;           ///< whether the file has the clip kRangesClip
    bool isHuman = false;             ///< Vrm::isHuman()
    std::string vrmNote;              ///< Vrm::note()
    std::vector<std::string> leftOut; ///< Vrm::leftOut()
};

/// Writes a character as a binary glTF file with a skeleton, for linear blending: joints, helper
/// joints, weights, morph targets, and all of these in every clip. Metres, Y up, facing +Z. Joints
/// have no rotation at rest. Correctives are further morph targets. With VRM 1's springs, and
/// VRMC_vrm for characters of VRM files.
///
/// \throw osgSkin::Error if it cannot be written
RiggedReport writeRigged(const std::string& file, const osgSkin::Character& character,
                         const std::vector<RiggedClip>& clips, const LinearSkinOptions& options);

} // namespace bake
