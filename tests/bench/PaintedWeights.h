// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>

#include "Subdivide.h"

#include <cstdint>
#include <string>
#include <vector>

namespace bench {

/// Linear blend weights, for the software rig that we are compared with.
struct Weights {
    using Vertex = std::vector<std::pair<std::uint32_t, float>>; ///< (joint, weight), by joint
    std::string name;
    std::vector<Vertex> vertices;

    /// Vertices with the same joints and weights share a group; a rig's cost is their number.
    std::size_t groupCount() const;
};

/// The hand-painted weights of a MakeHuman file; empty where it is not there.
Weights readPaintedWeights(const std::string& file, const std::vector<osgSkin::BoundJoint>& joints,
                           std::size_t vertices);

/// Weights that say the same as our own ratios: a joint's less those of its children.
Weights weightsFromRatios(const osgSkin::Binding& binding);

Weights blend(const Weights& weights, const std::vector<Blend>& vertices);

} // namespace bench
