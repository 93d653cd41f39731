// SPDX-License-Identifier: MIT
#pragma once

#include "bounds/CorrectiveStray.h"
#include "bounds/JointMotions.h"
#include "model/BoundsProxy.h"

namespace osgSkin {

/// A box that grows, three lanes each.
struct FourBox {
    Four low, high;
};

/// Adds pieces of skin, moved by a pose's joints, to a box.
class PosedPieces {
public:
    /// \param proxy of the pose's model
    /// \param motions the pose's
    /// \param corrections null where there are none
    PosedPieces(const BoundsProxy& proxy, JointMotions& motions,
                CorrectiveStray* corrections) noexcept
        : _proxy(proxy), _motions(motions), _corrections(corrections) {}

    /// \param piece of the proxy
    /// \param box expanded by it
    void add(const BoundsProxy::Piece& piece, FourBox& box) noexcept;

private:
    struct Strays {
        float free = 0.0f;     ///< how far vertices stray before the anchor moves them
        float anchored = 0.0f; ///< how much more by what they have less of the anchor
        float grown = 1.0f;    ///< the scale of the first, at least 1
    };
    template <bool Plain>
    Strays straysOf(const BoundsProxy::Piece& piece) const noexcept;

    const BoundsProxy& _proxy;
    JointMotions& _motions;
    CorrectiveStray* _corrections;
};

} // namespace osgSkin
