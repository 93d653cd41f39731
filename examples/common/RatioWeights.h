// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>

#include <Blending.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace compare {

/// Computes weights for other methods from bend ratios: a joint's weight is its ratio minus those
/// of its children, so the sum of the weights in a subtree is the ratio. Negative weights, where
/// two branches overlap (crotch), become 0.
inline SkinWeights weightsOf(const osgSkin::Binding& binding) {
    SkinWeights weights;
    std::vector<double> left(binding.joints.size());
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        std::fill(left.begin(), left.end(), 0.0);
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i) {
            const osgSkin::Influence& influence = binding.influences[i];
            left[influence.joint] += double(influence.bend);
            const int parent = binding.joints[influence.joint].parent;
            if (parent >= 0) left[static_cast<std::size_t>(parent)] -= double(influence.bend);
        }
        double sum = 0.0;
        for (double& weight : left) {
            if (!(weight > 1e-6)) weight = 0.0;
            sum += weight;
        }
        std::vector<JointWeight> vertex;
        for (std::uint32_t j = 0; j < left.size(); ++j) vertex.push_back({j, left[j] / sum});
        weights.add(vertex);
    }
    return weights;
}

} // namespace compare
