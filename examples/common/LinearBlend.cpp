// SPDX-License-Identifier: MIT
#include "LinearBlend.h"

namespace compare {

std::vector<glm::dmat4> linearBlendMatrices(const SkinWeights& weights,
                                            const std::vector<glm::dmat4>& skinning) {
    weights.validate(skinning.size());
    std::vector<glm::dmat4> result(weights.vertexCount(), glm::dmat4(0.0));
    for (std::size_t v = 0; v < result.size(); ++v)
        for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i)
            result[v] += weights.entries[i].weight * skinning[weights.entries[i].joint];
    return result;
}

std::vector<glm::dvec3> linearBlend(const std::vector<glm::dvec3>& rest, const SkinWeights& weights,
                                    const std::vector<glm::dmat4>& skinning) {
    return transformPoints(linearBlendMatrices(weights, skinning), rest);
}

} // namespace compare
