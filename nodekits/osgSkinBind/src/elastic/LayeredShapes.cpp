// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/LayeredShapes.h"

#include <vector>

namespace osgSkin {

void followBelow(const SkinLayers& layers, std::size_t welded, FittedShapes& shapes) {
    const std::size_t modes = shapes.functions.modes;
    if (layers.size() == 0 || modes == 0) return;
    std::vector<std::vector<glm::dvec3>> moves(modes, std::vector<glm::dvec3>(welded));
    for (std::size_t k = 0; k < modes; ++k) {
        for (std::size_t i = 0; i < shapes.vertices.size(); ++i)
            moves[k][shapes.vertices[i]] = shapes.vectors[i * modes + k];
        layers.follow(moves[k]);
    }
    shapes.vertices.clear();
    shapes.vectors.clear();
    for (std::uint32_t v = 0; v < welded; ++v) {
        bool moved = false;
        for (const std::vector<glm::dvec3>& mode : moves) moved = moved || mode[v] != glm::dvec3(0);
        if (!moved) continue;
        shapes.vertices.push_back(v);
        for (const std::vector<glm::dvec3>& mode : moves) shapes.vectors.push_back(mode[v]);
    }
}

} // namespace osgSkin
