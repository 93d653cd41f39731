// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SURFACE_SIMPLIFY_H
#define OSGSKINBIND_FIT_SURFACE_SIMPLIFY_H

#include "fit/surface/SurfaceMesh.h"

#include <functional>

namespace osgSkin::fit {

/// The surface with fewer triangles, where it has many: the flow costs time with every vertex, and
/// medial curves need no detail.
///
/// \param mesh closed
/// \param tell is called with the fraction that is done, 0 to 1; may be empty
Mesh simplified(const Mesh& mesh, const std::function<void(double)>& tell);

} // namespace osgSkin::fit

#endif
