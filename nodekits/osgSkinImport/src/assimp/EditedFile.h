// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMP_EDITEDFILE_H
#define OSGSKINIMPORT_ASSIMP_EDITEDFILE_H

#include <osgSkinImport/ReadLimits>

#include <string>

namespace Assimp {
class Importer;
} // namespace Assimp

namespace osgSkin {

/// Edits an FBX or Collada file in memory where Assimp does not read it as it is.
/// \param importer will read the edited bytes; unchanged for other formats
/// \return an FBX file's bytes, which the importer keeps; else empty
/// \throw osgSkin::Error if the file cannot be read, or Assimp would not return
const std::string& editFile(const std::string& path, const ReadLimits& limits,
                            Assimp::Importer& importer);

} // namespace osgSkin

#endif
