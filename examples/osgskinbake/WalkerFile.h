// SPDX-License-Identifier: MIT
#pragma once

#include "Arguments.h"

#include <osgSkinCharacter/Character>

namespace bake {

/// Writes the character as a walker, and says what it does.
/// \throw osgSkin::Error as makeWalker(), and where the file cannot be written
void writeWalker(osgSkin::Character& character, const Arguments& arguments);

} // namespace bake
