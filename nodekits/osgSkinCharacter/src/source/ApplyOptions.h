// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_SOURCE_APPLYOPTIONS_H
#define OSGSKINCHARACTER_SOURCE_APPLYOPTIONS_H

#include "source/CharacterSource.h"

#include <osgSkinCharacter/LoadOptions>

#include <string>

namespace osgSkin {

/// The user's cache folder: osgSkin in XDG_CACHE_HOME, or in .cache of the home folder (XDG Base
/// Directory Specification). Empty where neither is known.
std::string cacheFolder();

/// Applies the caller's options, which override the file's: binding and motions.
///
/// \param source with its motions or animations, but not necessarily with its body
/// \param options of the caller
/// \throw Error where the requested motion is neither one of the source's nor a file
void applyOptions(CharacterSource& source, const LoadOptions& options);

} // namespace osgSkin

#endif
