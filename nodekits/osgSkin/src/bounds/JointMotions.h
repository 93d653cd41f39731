// SPDX-License-Identifier: MIT
#pragma once

#include "model/BoundsProxy.h"
#include "points/Four.h"

#include <osgSkin/Pose>

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// What bounds need of a joint in a pose, in single precision: BoundsProxy::rounding is for that.
struct JointMotion {
    FourMap map;              ///< G
    float bend;               ///< psi
    float twist;              ///< |phi|
    float scaled;             ///< its own scale less 1
    float travel;             ///< by how much it is translated; of the root 0
    float scaling;            ///< its own scale's difference from 1
    float growth;             ///< its own scale, at least 1
    float growthHere;         ///< the product of the growths of this joint and those above it
    Four translation;         ///< the root's is in its map
    Four bendAxis, crossAxis; ///< v and v x w; JointMotions::turn() knows them
};

/// The same of the joints that a proxy needs.
class JointMotions {
public:
    /// \param proxy of the pose's model
    /// \param pose of the model's joints
    /// \param room for as many as the pose has joints
    JointMotions(const BoundsProxy& proxy, const Pose& pose, JointMotion* room) noexcept;

    const JointMotion& operator[](std::uint32_t joint) const noexcept { return _joints[joint]; }

    /// But for the root none is moved or scaled, nor is that scaled.
    bool isPlain() const noexcept { return _plain; }

    /// The map of a joint's turn by ratios.
    FourMap partialTurn(const BoundsProxy::Term& term) noexcept;

private:
    static constexpr std::size_t kKnown = 128; ///< the axes of more are worked out each time

    const BoundsProxy& _proxy;
    const Pose& _pose;
    JointMotion* _joints;
    std::bitset<kKnown> _known; ///< whose axes were worked out
    bool _plain = true;
};

} // namespace osgSkin
