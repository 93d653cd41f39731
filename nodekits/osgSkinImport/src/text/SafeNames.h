// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAFENAMES_H
#define OSGSKINIMPORT_SAFENAMES_H 1

#include <string>

namespace osgSkin {

/// Whether a file, by its extension, is one that OpenSceneGraph does no more with than read.
///
/// It runs scripts (`.lua`) where a model is asked for, unpacks archives by a shell's command with
/// the file's name in it (`.tgz`) or reads what is in them past our guard (`.gz`, `.osga`), opens
/// ports (`.osc`) and databases in a network (`.gdal`).
/// \param path as it would be given to OpenSceneGraph
bool isOnlyRead(const std::string& path);

/// Throws osgSkin::Error where isOnlyRead() is false.
void requireOnlyRead(const std::string& path);

} // namespace osgSkin

#endif
