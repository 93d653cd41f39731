// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_NORMALCORRECTIVES_H
#define OSGSKINBIND_NORMALCORRECTIVES_H

#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>

namespace osgSkin {

/// Gives a binding's correctives, whoever made them, what normals need beside the gradients: each
/// joint is bent all over its range, and what the normals of the corrected skin are off by then is
/// fitted to the functions that the joint has already.
/// \param binding of the mesh as given, with gradients; changed
void addNormalCorrectives(const WeldedMesh& mesh, Binding& binding);

} // namespace osgSkin

#endif
