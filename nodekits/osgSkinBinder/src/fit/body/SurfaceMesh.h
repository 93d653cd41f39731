// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_SURFACEMESH_H
#define OSGSKINBINDER_FIT_SURFACEMESH_H

#include "fit/body/CurveSkeleton.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

/// The CGAL types of skeleton fitting, and what is compiled apart because of them.
namespace osgSkin::fit {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

inline glm::dvec3 vector(const Kernel::Point_3& p) {
    return {p.x(), p.y(), p.z()};
}

inline Kernel::Point_3 point(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

/// Mean curvature flow skeleton (Tagliasacchi, Alhashim, Olson & Zhang 2012) of a closed surface.
CurveSkeleton contract(const Mesh& mesh);

} // namespace osgSkin::fit

#endif
