// SPDX-License-Identifier: MIT
#pragma once

#include "bounds/BlendKernel.h"
#include "bounds/PosedPieces.h"

#include <array>
#include <cstddef>

namespace osgSkin {

/// Boxes of all pieces of skin in a plain pose, by linear blending: they tell which pieces need to
/// be looked at more closely.
class BlendedPieces {
public:
    /// \param proxy of the pose's model
    /// \param motions the pose's, which is plain
    BlendedPieces(const BoundsProxy& proxy, const JointMotions& motions) noexcept;

    /// Expands a box until it holds all vertices: by the pieces whose boxes reach furthest out,
    /// then by those of the others whose boxes reach far out of it, then by the rest of the boxes.
    ///
    /// \param pieces of the same pose
    /// \param box expanded
    void addTo(PosedPieces& pieces, FourBox& box) noexcept;

private:
    static constexpr std::size_t kMostBlocks =
        (BoundsProxy::kMostCorrected + BoundsProxy::kAtOnce - 1) / BoundsProxy::kAtOnce;

    /// A box's sides, each in all lanes.
    struct Sides {
        Four low[3], high[3];
    };
    static Sides sidesOf(const Four& low, const Four& high) noexcept;
    /// The lanes of a block whose boxes reach out of another one, a bit each.
    unsigned int outside(std::size_t block, const Sides& sides) const noexcept;

    /// Around the boxes of the pieces that were not taken.
    FourBox around() const noexcept;
    /// Takes pieces themselves in place of their boxes.
    void take(std::size_t block, unsigned int lanes, PosedPieces& pieces, FourBox& box) noexcept;

    const BoundsProxy& _proxy;
    std::array<BlendedBlock, kMostBlocks> _blocks;
};

} // namespace osgSkin
