// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "options/LoadReport.h"

#include <osgSkinCharacter/Character>
#include <osgSkinCharacter/LoadOptions>

#include <string>

namespace osgSkin {

/// Reads a scene by osgDB and re-skins the rigs in it, where they are.
///
/// \param file any name that osgDB reads, also a pseudo-loader's, which is no file
/// \param options of the caller
/// \param stages are planned and told
/// \return a character, without a body where it has several, see Character::hasBody()
/// \throw Error with the file and the reason, also where nothing in it is rigged, or has no such motion
Character convertScene(const std::string& file, const LoadOptions& options, LoadStages& stages);

} // namespace osgSkin
