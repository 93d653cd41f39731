// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinCharacter/Character>

#include <string>

namespace test {

/// A character's mean distance from linear blending over the vertices, relative to the body's size;
/// the largest over all clips and times.
struct BlendError {
    double whole = 0.0; ///< of vertices with weights of 0 and 1 only
    double mixed = 0.0; ///< of the others
    std::string clip;   ///< with the largest `whole`
    std::size_t clips = 0;
};

/// Plays all clips of a glTF character, or poses it like its nodes if it has none.
/// \param character to play
/// \param file that the character was loaded from
BlendError blendError(osgSkin::Character& character, const std::string& file);

/// The same of a file with default options.
BlendError blendError(const std::string& file);

} // namespace test
