// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/PackShapes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// The most that each mode is scaled by at any bend: no more than its functions' bounds give.
std::vector<double> largestWeights(const CorrectiveJoint& joint) {
    constexpr int kGrid = 24;
    std::vector<double> largest(joint.modes, 0.0);
    CorrectiveJoint::Functions phi;
    for (int i = 0; i <= kGrid; ++i)
        for (int j = 0; j <= kGrid; ++j) {
            const glm::dvec2 xy = joint.low + (joint.high - joint.low) *
                                                  glm::dvec2(double(i), double(j)) / double(kGrid);
            joint.evaluate(joint.clamped(xy), phi);
            for (std::size_t k = 0; k < joint.modes; ++k) {
                double weight = 0.0;
                for (std::size_t f = 0; f < joint.functionCount(); ++f)
                    weight += joint.coefficients[k * joint.functionCount() + f] * phi[f];
                largest[k] = std::max(largest[k], std::abs(weight));
            }
        }
    return largest;
}

/// How many modes a vertex needs: what the others would move it by makes no difference.
std::size_t modesNeeded(const glm::dvec3* vectors, const std::vector<double>& largest,
                        double tolerance) {
    double rest = 0.0;
    for (std::size_t modes = largest.size(); modes > 0; --modes) {
        rest += largest[modes - 1] * glm::length(vectors[modes - 1]);
        if (rest > tolerance) return modes;
    }
    return 0;
}

struct VertexEntry {
    std::uint32_t joint; ///< of the correctives'
    std::size_t first;   ///< in the joint's vectors
    std::size_t modes;   ///< that the vertex needs
};

} // namespace

Correctives packShapes(const std::vector<FittedShapes>& joints,
                       const std::vector<std::uint32_t>& weldedOf) {
    Correctives result;
    std::size_t welded = 0;
    for (const std::uint32_t w : weldedOf) welded = std::max<std::size_t>(welded, w + 1);
    std::vector<std::vector<VertexEntry>> entries(welded);
    std::vector<const FittedShapes*> kept;
    for (const FittedShapes& joint : joints) {
        const std::size_t modes = joint.functions.modes;
        if (modes == 0 || kept.size() == Correctives::kMostJoints) continue;
        const std::vector<double> largest = largestWeights(joint.functions);
        for (std::size_t v = 0; v < joint.vertices.size(); ++v) {
            const std::size_t needed =
                modesNeeded(&joint.vectors[v * modes], largest, joint.tolerance);
            if (needed > 0)
                entries[joint.vertices[v]].push_back(
                    {static_cast<std::uint32_t>(kept.size()), v * modes, needed});
        }
        kept.push_back(&joint);
        result.joints.push_back(joint.functions);
    }
    if (kept.empty()) return {};
    result.firstEntry.push_back(0);
    for (const std::uint32_t w : weldedOf) {
        for (const VertexEntry& entry : entries[w]) {
            result.entries.push_back(
                {entry.joint, static_cast<std::uint32_t>(result.shares.size())});
            const glm::dvec3* vector = &kept[entry.joint]->vectors[entry.first];
            for (std::size_t k = 0; k < entry.modes; ++k)
                for (int axis = 0; axis < 3; ++axis)
                    result.shares.push_back(static_cast<std::int16_t>(
                        std::lrint(Correctives::kUnit * vector[k][axis])));
            result.shares.resize(result.entries.back().firstShare + result.sharesOf(entry.joint),
                                 0);
        }
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result.entries.empty() ? Correctives{} : result;
}

} // namespace osgSkin
