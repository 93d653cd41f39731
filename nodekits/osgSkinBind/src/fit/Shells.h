// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SHELLS_H
#define OSGSKINBIND_FIT_SHELLS_H

#include "fit/solid/SolidGrid.h"
#include "mesh/WeldedMesh.h"

#include <string>

namespace osgSkin {

/// Whether a mesh is one shell at most, without walls in it.
bool isOneSkin(const WeldedMesh& mesh);

/// The longest extent of the shell with the largest area over that of all.
double largestShellShare(const WeldedMesh& mesh);

/// What all shells fill together.
fit::SolidGrid filledByAll(const WeldedMesh& mesh);

/// The largest shells with their sizes and where they are, as part of a line.
std::string describeShells(const WeldedMesh& mesh);

} // namespace osgSkin

#endif
