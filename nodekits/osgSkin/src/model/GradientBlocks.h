// SPDX-License-Identifier: MIT
#pragma once

#include "model/SkinBlocks.h"

#include <osgSkin/Binding>
#include <osgSkin/SkinModel>

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// One number of each vertex of a block.
struct alignas(32) GradientRow {
    std::int16_t lane[kBlock];
};

/// Two directions along the skin at a vertex, u and v = n x u, that its gradients are held by.
struct SkinDirections {
    glm::dvec3 u, v;
};

/// Always the same ones for a normal, which is of unit length; rest space.
SkinDirections skinDirections(const glm::vec3& normal);

/// A SkinModel's ratio gradients as the kernel reads them, and the only place that a model has them
/// in.
///
/// Block by block as SkinBlocks; a block is three rows of u in the blocks' frame, and
/// rowsPerBlock(n) rows for n partial links, of each, innermost first: the bend ratio's gradient
/// along u and along v, the twist ratio's along u and along v. Gradients of links that are followed
/// wholly are left out.
struct GradientBlocks {

    /// A bound of how far a turn by one radian can tilt a normal of the group, in radians: the
    /// longest product of a gradient and the distance from what the link turns about.
    struct Reach {
        float bend, twist;
    };

    /// \param source as SkinModel::create() takes it; the binding is valid and the model's
    GradientBlocks(const SkinModel& model, const Binding& binding,
                   const std::vector<std::uint32_t>& source);

    static std::size_t rowsPerBlock(std::size_t partialCount) { return 4 * partialCount; }
    static constexpr std::size_t kDirectionRows = 3;

    /// What 1 in `rows` is, per rest unit. A power of two: what is read from a model gives the same
    /// model again.
    double unit = 1.0;
    std::vector<BlockRow> directions; ///< u of SkinBlocks::firstBlock's blocks
    std::vector<GradientRow> rows;
    std::vector<std::size_t> firstRow;   ///< of each group
    std::vector<Reach> reach;            ///< of each group's partial links, outermost first
    std::vector<std::size_t> firstReach; ///< of each group

    /// The first row of the block in which a vertex stands.
    const GradientRow* blockOf(const SkinModel& model, std::size_t group,
                               std::uint32_t row) const noexcept {
        return &rows[firstRow[group] +
                     row / kBlock * rowsPerBlock(model.groups()[group].partialCount)];
    }
};

/// The gradients of each vertex's links, a group's one after the other: as
/// SkinModel::Group::linkCount a vertex, in the groups' order. Empty where the model has none.
std::vector<RatioGradient> gradientsOf(const SkinModel& model);

} // namespace osgSkin
