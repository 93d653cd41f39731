// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "source/CharacterSource.h"

#include <osgSkinCharacter/Character>
#include <osgSkinCharacter/LoadOptions>

namespace osgSkin {

/// Builds the scene of a bound character, Z up: skeleton, skins, rigid parts, props, and the
/// manager that plays its motions; in the pose that the first one begins with.
///
/// \param source that the character is made of; its skeleton becomes the scene's
/// \param options of the caller
/// \param character with its body, rest skeleton, binding and retargeted motions; gets the scene
/// \throw Error where parts do not fit, or a prop cannot be read
void buildScene(CharacterSource& source, const LoadOptions& options, Character& character);

} // namespace osgSkin
