// SPDX-License-Identifier: MIT
#pragma once

#include "model/SkinBlocks.h"

#include <osgSkin/Binding>
#include <osgSkin/SkinModel>

#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// One number of each vertex of a block.
struct alignas(32) GradientRow {
    std::int16_t lane[kBlock];
};

/// A direction that is not along the normal of any vertex of a block; unit.
struct BlockAcross {
    float across[3];
};

/// The one that blocks have where it is far enough from their normals: a limb's skin looks across
/// the limb's axis, which is the third one of a joint's frame. The kernel needs fewer steps then.
constexpr BlockAcross kAlongFrame{{0.0f, 0.0f, -1.0f}};

/// Two directions along the skin at a vertex that its gradients are held by: v = n x across and
/// u = v x n, perpendicular and of one length.
struct SkinDirections {
    glm::dvec3 u, v;
};

/// \param normal unit, or 0; rest space
/// \param frame restFrame() of the vertex's group, in which `across` is
/// \param across of the vertex's block
/// \return rest space
SkinDirections skinDirections(const glm::vec3& normal, const glm::dmat3& frame,
                              const BlockAcross& across);

/// A SkinModel's ratio gradients as the kernel reads them, and the only place that a model has them
/// in.
///
/// Block by block as SkinBlocks; a block is what is across its skin, in the blocks' frame, and
/// rowsPerBlock(n) rows for n partial links, of each, innermost first: the bend ratio's gradient
/// times u and times v, the twist ratio's times u and times v. Gradients of links that are followed
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

    /// What 1 in `rows` is, per rest unit; a few gradients that are far steeper than the others are
    /// cut. A power of two: what is read from a model gives the same model again.
    double unit = 1.0;
    std::vector<BlockAcross> across; ///< of SkinBlocks::firstBlock's blocks
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

    /// Of the block in which a vertex stands.
    const BlockAcross& acrossOf(const SkinModel& model, std::size_t group,
                                std::uint32_t row) const noexcept;
};

/// The gradients of each vertex's links, a group's one after the other: as
/// SkinModel::Group::linkCount a vertex, in the groups' order. Empty where the model has none.
std::vector<RatioGradient> gradientsOf(const SkinModel& model);

/// Which changes along a partial link's ratios tilt a group's normals in a pose so far that anybody
/// could see it; the others are left out.
struct LinkTilt {
    static constexpr double kLeast = 1e-3; ///< radians

    bool bends = false;  ///< those of the bend ratio
    bool twists = false; ///< those of the twist ratio
    bool moves = false;  ///< those of the joint's translation and scale, which come with the bend

    bool any() const { return bends || twists || moves; }
};

/// \param bendAngle psi
/// \param twistAngle phi
/// \param moves whether the joint is moved or scaled
inline LinkTilt linkTilt(const GradientBlocks::Reach& reach, double bendAngle, double twistAngle,
                         bool moves) noexcept {
    return {std::abs(bendAngle) * static_cast<double>(reach.bend) > LinkTilt::kLeast,
            std::abs(twistAngle) * static_cast<double>(reach.twist) > LinkTilt::kLeast, moves};
}

} // namespace osgSkin
