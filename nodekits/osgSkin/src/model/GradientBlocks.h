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

/// A unit direction that is not parallel to the normal of any vertex of a block.
struct BlockAcross {
    float across[3];
};

/// The preferred one, with which the kernel needs fewer steps: normals of a limb are mostly
/// perpendicular to its axis, the third of a joint's frame.
constexpr BlockAcross kAlongFrame{{0.0f, 0.0f, -1.0f}};

/// Two directions along the skin at a vertex, of equal length and perpendicular: v = n x across and
/// u = v x n. Gradients are stored as components along them.
struct SkinDirections {
    glm::dvec3 u, v;
};

/// \param normal unit, or 0; rest space
/// \param frame restFrame() of the vertex's group, in which `across` is
/// \param across of the vertex's block
/// \return rest space
SkinDirections skinDirections(const glm::vec3& normal, const glm::dmat3& frame,
                              const BlockAcross& across);

/// A SkinModel's ratio gradients as the kernel reads them; the model's only copy.
///
/// Block by block as SkinBlocks. A block has a BlockAcross, in the blocks' frame, and
/// rowsPerBlock(n) rows for n partial links, innermost first: the bend ratio's gradient along u and
/// along v, then the twist ratio's. Full links have none.
struct GradientBlocks {
    /// A bound of how far a rotation by one radian tilts any normal of the group, in radians: the
    /// largest product of a gradient and the distance from the link's centre.
    struct Reach {
        float bend, twist;
    };

    /// \param source as SkinModel::create() takes it; the binding is valid and the model's
    GradientBlocks(const SkinModel& model, const Binding& binding,
                   const std::vector<std::uint32_t>& source);
    /// Of data from a file, without `firstRow` and `firstReach`.
    ///
    /// \throw osgSkin::Error where it does not fit the model, or a number is not finite
    GradientBlocks(const SkinModel& model, GradientBlocks&& from);
    GradientBlocks() = default;

    static std::size_t rowsPerBlock(std::size_t partialCount) { return 4 * partialCount; }

    /// The value of 1 in `rows`, per rest unit; a few far steeper gradients are clamped. A power of
    /// two, so that gradients read from a model give the same model again.
    double unit = 1.0;
    std::vector<BlockAcross> across; ///< of SkinBlocks::firstBlock's blocks
    std::vector<GradientRow> rows;
    std::vector<std::size_t> firstRow;   ///< of each group
    std::vector<Reach> reach;            ///< of each group's partial links, outermost first
    std::vector<std::size_t> firstReach; ///< of each group

    /// The first row of a vertex's block.
    const GradientRow* blockOf(const SkinModel& model, std::size_t group,
                               std::uint32_t row) const noexcept {
        return &rows[firstRow[group] +
                     row / kBlock * rowsPerBlock(model.groups()[group].partialCount)];
    }

    /// Of a vertex's block.
    const BlockAcross& acrossOf(const SkinModel& model, std::size_t group,
                                std::uint32_t row) const noexcept;
};

/// The gradients of a model: for each vertex, in the groups' order, one for each of its links.
/// Empty where the model has none.
std::vector<RatioGradient> gradientsOf(const SkinModel& model);

/// Which gradients of a partial link tilt a group's normals visibly in a pose; others are left out.
struct LinkTilt {
    static constexpr double kMin = 1e-3; ///< radians

    bool bends = false;  ///< the bend ratio's
    bool twists = false; ///< the twist ratio's
    bool moves = false;  ///< the bend ratio's, by the joint's translation and scale

    bool any() const { return bends || twists || moves; }
};

/// \param bendAngle psi
/// \param twistAngle phi
/// \param moves whether the joint is moved or scaled
inline LinkTilt linkTilt(const GradientBlocks::Reach& reach, double bendAngle, double twistAngle,
                         bool moves) noexcept {
    return {std::abs(bendAngle) * static_cast<double>(reach.bend) > LinkTilt::kMin,
            std::abs(twistAngle) * static_cast<double>(reach.twist) > LinkTilt::kMin, moves};
}

} // namespace osgSkin
