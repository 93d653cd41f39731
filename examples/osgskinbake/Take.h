// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "load/Character.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bake {

/// A motion that a character can be posed in, frame by frame.
struct Take {
    std::string name;
    std::size_t frames = 0;
    double frameTime = 0.0;                ///< seconds from one frame to the next
    std::string notes;                     ///< on its feet, lines of text; may be empty
    std::function<void(std::size_t)> pose; ///< puts bones and skins into that frame, exactly
};

/// The motions of a `.skin` file with their files' own samples, or the clips of a rigged model with
/// `rate` samples a second. They refer to `character`.
std::vector<Take> takesOf(osgSkin::Character& character, double rate);

/// Reads a `.skin` file, or a rigged model, with or without `.skin` after its name, as the plug-in
/// does. \param shapes none or fast; empty: as the character has them \param quiet without progress
/// on the terminal \throw osgSkin::Error with the file and the reason
osgSkin::Character loadCharacter(const std::string& file, const std::string& shapes, bool quiet);

} // namespace bake
