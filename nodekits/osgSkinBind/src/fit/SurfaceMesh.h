// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SURFACEMESH_H
#define OSGSKINBIND_FIT_SURFACEMESH_H

#include "../WeldedMesh.h"
#include "CurveSkeleton.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <functional>
#include <string>
#include <vector>

/// What skeleton fitting asks of CGAL, so that few files have to compile its templates.
namespace osgSkin::fit {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

inline glm::dvec3 vector(const Kernel::Point_3& p) {
    return {p.x(), p.y(), p.z()};
}

inline Kernel::Point_3 point(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

/// The shell with the largest area, oriented, its holes closed.
///
/// \param notes gets one line for each thing that was left out or closed
///
/// \throw Error where that does not give one closed surface
Mesh closedSurface(const WeldedMesh& mesh, std::vector<std::string>& notes);

/// The surface with fewer triangles, where it has many: the flow costs time with every vertex, and
/// medial curves need no detail.
/// \param tell is called with the share that is done, 0 to 1; may be empty
Mesh simplified(const Mesh& mesh, const std::function<void(double)>& tell);

/// Mean curvature flow skeleton (Tagliasacchi, Alhashim, Olson & Zhang 2012) of a closed surface.
/// \param tell as with simplified(), which comes first
CurveSkeleton contract(const Mesh& mesh, const std::function<void(double)>& tell);

} // namespace osgSkin::fit

#endif
