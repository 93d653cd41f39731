// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinCharacter/Character>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace bake {

/// A motion that a character can be posed in, frame by frame.
struct SampledMotion {
    std::string name;
    std::size_t frames = 0;
    double frameTime = 0.0;                ///< seconds from one frame to the next
    std::string notes;                     ///< on its feet, lines of text; may be empty
    std::function<void(std::size_t)> pose; ///< puts bones and skins into that frame, exactly
};

/// The character's motions: those of motion files with the files' own samples, a rigged model's own
/// animations with `rate` samples a second. They refer to `character`.
std::vector<SampledMotion> sampledMotions(osgSkin::Character& character, double rate);

} // namespace bake
