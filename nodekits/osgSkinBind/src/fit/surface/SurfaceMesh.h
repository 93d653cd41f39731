// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SURFACEMESH_H
#define OSGSKINBIND_FIT_SURFACEMESH_H

#include "fit/surface/CurveSkeleton.h"
#include "mesh/WeldedMesh.h"

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

} // namespace osgSkin::fit

#endif
