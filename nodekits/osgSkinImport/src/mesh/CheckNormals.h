// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKNORMALS_H
#define OSGSKINIMPORT_CHECKNORMALS_H 1

#include "mesh/CornerMesh.h"

#include <string>

namespace osgSkin {

/// Computes the normals of a material anew, smooth over the skin, where most of its faces' area has
/// normals on the faces' back: exporters mirror one without the other. Says so in a notice.
/// \param mesh with unit normals
void mendNormals(CornerMesh& mesh, const std::string& path);

} // namespace osgSkin

#endif
