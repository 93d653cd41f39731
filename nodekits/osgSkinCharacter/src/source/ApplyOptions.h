// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "source/CharacterSource.h"

#include <osgSkinCharacter/LoadOptions>

namespace osgSkin {

/// Puts what the caller asks for in place of what the file says: how to bind, and which motions.
///
/// \param source with its motions or animations, but not necessarily with its body
/// \param options of the caller
/// \throw Error where the motion asked for is neither one of the source's nor a file
void applyOptions(CharacterSource& source, const LoadOptions& options);

} // namespace osgSkin
