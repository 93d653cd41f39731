// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "options/LoadReport.h"
#include "source/CharacterSource.h"

#include <osgSkinCharacter/LoadOptions>

#include <string>

namespace osgSkin {

/// Reads a rigged model by Assimp: body, painted weights, skeleton and animations.
///
/// \param file for which isReadByAssimp() holds
/// \param options are applied, see applyOptions()
/// \param stages are planned for the whole load, and told of the first one
/// \return all that the character is made of
/// \throw Error with the file and the reason
CharacterSource readRig(const std::string& file, const LoadOptions& options, LoadStages& stages);

} // namespace osgSkin
