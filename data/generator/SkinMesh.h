// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <glm/vec3.hpp>

namespace mannequin {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SkinMesh = CGAL::Surface_mesh<Kernel::Point_3>;

inline glm::dvec3 toGlm(const Kernel::Point_3& p) {
    return {p.x(), p.y(), p.z()};
}
inline Kernel::Point_3 toCgal(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

} // namespace mannequin
