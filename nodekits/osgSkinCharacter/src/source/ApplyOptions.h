// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_SOURCE_APPLYOPTIONS_H
#define OSGSKINCHARACTER_SOURCE_APPLYOPTIONS_H

#include "source/CharacterSource.h"

#include <osgSkinCharacter/LoadOptions>

namespace osgSkin {

/// Applies the caller's options, which override the file's: binding and motions.
///
/// \param source with its motions or animations, but not necessarily with its body
/// \param options of the caller
/// \throw Error where the requested motion is neither one of the source's nor a file
void applyOptions(CharacterSource& source, const LoadOptions& options);

} // namespace osgSkin

#endif
