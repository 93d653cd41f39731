// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAFENAMES_H
#define OSGSKINIMPORT_SAFENAMES_H 1

#include <osgDB/Options>

#include <cstddef>
#include <string>

namespace osgSkin {

/// No file has a longer name (PATH_MAX).
constexpr std::size_t kLongestPath = 4096;

/// Throws osgSkin::Error for what names no file: a byte 0, at which some readers end a name and
/// others do not, and more than kLongestPath bytes.
void requireName(const std::string& path);

/// Whether a file, by its extension, is one that OpenSceneGraph does no more with than read.
///
/// It runs scripts (`.lua`) where a model is asked for, unpacks archives by a shell's command with
/// the file's name in it (`.tgz`) or reads what is in them past our guard (`.gz`, `.osga`, also
/// where they stand before a slash), opens ports (`.osc`) and databases in a network (`.gdal`).
/// \param path as it would be given to OpenSceneGraph
bool isOnlyRead(const std::string& path);

/// Throws osgSkin::Error where isOnlyRead() is false, and as requireName().
void requireOnlyRead(const std::string& path);

} // namespace osgSkin

#endif
