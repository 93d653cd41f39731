// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/steps/LimitSteps.h"

#include "shapes/steps/BendSteps.h"
#include "shapes/steps/HeldVectors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <unordered_map>
#include <vector>

namespace osgSkin {
namespace {

/// How far a vertex' limit reaches to its neighbours, in radii.
constexpr double kFade = 0.7;

/// What vertices keep where neighbours of those with less than a whole share may have no more than
/// a little more.
std::vector<double> faded(const std::vector<const ShapedJoint::Vertex*>& vertices,
                          const std::vector<double>& shares, double radius) {
    std::vector<double> result = shares;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (shares[v] >= 1.0) continue;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double away = glm::distance(vertices[i]->from, vertices[v]->from);
            result[i] = std::min(result[i], shares[v] + away / (kFade * radius));
        }
    }
    return result;
}

} // namespace

void limitSteps(const ShapedJoint& joint, FittedShapes& shapes) {
    const std::size_t modes = shapes.functions.modes;
    if (modes == 0) return;
    std::unordered_map<std::uint32_t, const ShapedJoint::Vertex*> known;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) known[vertex.index] = &vertex;
    const BendSteps steps(joint, shapes.functions);
    const HeldVectors vectors(joint, steps, modes);
    std::vector<const ShapedJoint::Vertex*> vertices;
    std::vector<double> shares; // what is left of their shapes
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
        vertices.push_back(known.at(shapes.vertices[v]));
        shares.push_back(vectors.hold(*vertices.back(), &shapes.vectors[v * modes]));
    }
    const std::vector<double> kept = faded(vertices, shares, joint.radius);
    for (std::size_t v = 0; v < shares.size(); ++v) {
        if (kept[v] >= shares[v]) continue;
        for (std::size_t k = 0; k < modes; ++k)
            shapes.vectors[v * modes + k] *= kept[v] / shares[v];
    }
}

} // namespace osgSkin
