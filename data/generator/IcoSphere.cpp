// SPDX-License-Identifier: GPL-3.0-or-later
#include "IcoSphere.h"

#include <CGAL/boost/graph/generators.h>
#include <CGAL/subdivision_method_3.h>

#include <glm/geometric.hpp>

namespace mannequin {

SkinMesh icoSphere(double radius) {
    SkinMesh mesh;
    CGAL::make_icosahedron(mesh, Kernel::Point_3(0, 0, 0), 1.0);
    CGAL::Subdivision_method_3::Loop_subdivision(mesh, CGAL::parameters::number_of_iterations(2));
    for (const auto v : mesh.vertices())
        mesh.point(v) = toCgal(glm::normalize(toGlm(mesh.point(v))) * radius);
    return mesh;
}

} // namespace mannequin
