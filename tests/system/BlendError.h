// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinCharacter/Character>

#include <string>

namespace test {

/// How far a character lies from linear blending, in the mean over the vertices, as a part of the
/// body's size: the most of all clips and times that were looked at.
struct BlendError {
    double whole = 0.0; ///< of vertices with weights of 0 and 1 only
    double mixed = 0.0; ///< of the others
    std::string clip;   ///< in which `whole` is the most
    std::size_t clips = 0;
};

/// Plays all of a glTF character's clips, and stands it as its nodes do where it has none.
/// \param file that the character was loaded from
BlendError blendError(osgSkin::Character& character, const std::string& file);

/// The same of a file with default options.
BlendError blendError(const std::string& file);

} // namespace test
