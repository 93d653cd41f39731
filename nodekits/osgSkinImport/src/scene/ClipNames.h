// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CLIPNAMES_H
#define OSGSKINIMPORT_CLIPNAMES_H 1

#include "scene/SourceScene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// Names for a scene's clips, each of its own: "clip2" for one without, "walk 2" for another
/// "walk".
std::vector<std::string> clipNames(const SourceScene& scene);

/// Finds a clip by its name, by what stands behind the last '|' of it (as in "Armature|walk") where
/// only one clip has that, or by its number, from 0.
/// \param names of the file's clips
/// \throw osgSkin::Error with `path` and the clips that there are
std::size_t findClip(const std::vector<std::string>& names, const std::string& wanted,
                     const std::string& path);

} // namespace osgSkin

#endif
