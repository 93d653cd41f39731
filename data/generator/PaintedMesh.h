// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "PedestrianBody.h"
#include "SkinMesh.h"

#include <array>
#include <iosfwd>
#include <string>
#include <vector>

namespace mannequin {

/// A triangle mesh with a material for each face.
struct PaintedMesh {
    std::vector<glm::dvec3> points;
    std::vector<std::array<std::size_t, 3>> faces;
    std::vector<Material> materials; ///< of the faces
};

/// Paints a skin whose edges follow the materials' edges.
PaintedMesh painted(const SkinMesh& mesh, const ImplicitBody& body);

/// Tucks one material below the edge of another, which becomes a ledge. It ends where a third one
/// meets them.
void tuck(PaintedMesh& mesh, const Tuck& edge, const ImplicitBody& body);

/// The same mesh without materials.
SkinMesh unpainted(const PaintedMesh& mesh);

/// Writes a mesh as Wavefront OBJ, and its materials as MTL.
void writePaintedObj(std::ostream& out, const PaintedMesh& mesh, const std::string& name);
void writeMaterials(std::ostream& out);

} // namespace mannequin
