// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CLIPNAMES_H
#define OSGSKINIMPORT_CLIPNAMES_H 1

#include "scene/SourceScene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// Unique names for a scene's clips: "clip2" for a clip without a name, "walk 2" for a second
/// "walk".
std::vector<std::string> clipNames(const SourceScene& scene);

/// Finds a clip by its name, by the part of its name after the last '|' ("Armature|walk"), also
/// without the object's name behind it ("Armature|walk_Armature"), if only one clip has that, or by
/// its number, from 0.
/// \param names of the file's clips
/// \param wanted name or number
/// \param path of the file, for errors
/// \throw osgSkin::Error with `path` and the available clips
std::size_t findClip(const std::vector<std::string>& names, const std::string& wanted,
                     const std::string& path);

} // namespace osgSkin

#endif
