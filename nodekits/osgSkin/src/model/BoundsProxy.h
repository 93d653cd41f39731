// SPDX-License-Identifier: MIT
#pragma once

#include "points/EllipticCylinder.h"

#include <osgSkin/SkinModel>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgSkin {

/// Pieces of skin that stand for their vertices when a pose's bounds are computed.
///
/// A piece is a cylinder that holds its rest vertices, and moves rigidly: wholly with one joint
/// (its anchor) and all above it, then by fixed ratios with some more. A vertex x of it goes
/// through P_1(r_1) ... P_n(r_n) x, a cylinder's point through the same with the piece's ratios s.
/// With z the vertex before joint k turns it, at most `high` from the joint's centre and `wide`
/// from its twist axis, it strays by at most
///
///   |P_k(r) z - P_k(s) z| <= |bend of r - s| psi high + |twist of r - s| |phi| wide
///
/// for each joint, since all that follow are turns, which keep distances. The joints applied before
/// k move z from x by at most as much as they turn times how far it is from them.
struct BoundsProxy {
    /// One joint that a piece's vertices follow, from where they all follow them wholly on.
    struct Term {
        std::uint32_t joint;
        bool turns;        ///< the piece, by ratios of its own; else not, or with its anchor
        float bend, twist; ///< ratios of the piece; where it turns
        float bendSpread;  ///< the largest difference of a vertex's ratio from the piece's
        float twistSpread;
        float mostBend; ///< of the vertices
        float mostTwist;
        // The same times `high` and `wide` as they are where joints applied before do not turn.
        float bendReach, twistReach;
        float bendMove, twistMove;
        // The differences from a piece that moves wholly with its home joint.
        float homeBendSpread, homeTwistSpread, homeBendReach, homeTwistReach;
        float mostHigh; ///< the largest `high` whatever they do, but move and scale
    };
    /// That vertices of a piece follow the correctives of a joint.
    struct Correction {
        std::uint32_t joint;      ///< of the correctives'
        std::uint32_t firstReach; ///< in `reach`: one for each mode
    };
    struct Piece {
        EllipticCylinder rest;
        float radius;    ///< of the ball about its centre
        float corrected; ///< how far correctives can take a vertex in any pose, or more
        std::uint32_t anchor;
        std::uint32_t home; ///< the last joint, from the anchor on, that it mostly moves with
        std::uint32_t firstTerm, termCount; ///< innermost (applied first) first
        std::uint32_t firstCorrection, correctionCount;
    };

    /// Pieces that a skin is cut into at most, without correctives and with them.
    static constexpr std::size_t kMost = 128, kMostCorrected = 160;

    std::vector<Piece> pieces; ///< those that no term turns stand first
    std::vector<Term> terms;
    std::vector<Correction> corrections;
    std::vector<float> reach; ///< length of a piece's largest shares, as they are held
    float rounding;           ///< what single precision may put a vertex off by, near the origin
};

/// Cuts a model's vertices into pieces; null for a model without vertices.
std::shared_ptr<const BoundsProxy> makeBoundsProxy(const SkinModel& model);

} // namespace osgSkin
