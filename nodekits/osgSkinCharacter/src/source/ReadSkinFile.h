// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "options/LoadReport.h"
#include "source/CharacterSource.h"

#include <osgSkinCharacter/LoadOptions>

#include <string>

namespace osgSkin {

/// Reads a `.skin` file, the mesh and the skeleton that it names, or fits a skeleton.
///
/// \param file its path
/// \param options are applied, see applyOptions()
/// \param stages are planned for the whole load, and told of the first ones
/// \return all that the character is made of
/// \throw Error with file, JSON path and what was expected
CharacterSource readSkinFile(const std::string& file, const LoadOptions& options,
                             LoadStages& stages);

} // namespace osgSkin
