// SPDX-License-Identifier: MIT
#pragma once

#include "core/Four.h"

#include <osgSkin/Correctives>
#include <osgSkin/SkinModel>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgSkin {

/// Pieces of skin that represent their vertices when a pose's bounds are computed.
///
/// A piece is a cylinder around its rest vertices that moves rigidly: fully with one joint (its
/// anchor) and all above, then with further joints by fixed ratios. A vertex x becomes P_1(r_1) ...
/// P_n(r_n) x, a point of the cylinder the same with the piece's ratios s. With z the vertex before
/// joint k rotates it, at most `high` from the joint's centre and `wide` from its twist axis, it
/// deviates by at most
///
///   |P_k(r) z - P_k(s) z| <= |bend of r - s| psi high + |twist of r - s| |phi| wide
///
/// for each joint, since the rotations that follow keep distances. The joints applied before k move
/// z away from x by at most their angles times its distances from them.
///
/// Most pieces are well inside the box. A cheaper bound shows that, for several pieces at once: the
/// distance of vertices from linear blending with one ratio s_k per joint (the bend's, which moves
/// vertices further than the twist). With `far` the largest `high` of all poses, and t_k = psi_k +
/// |phi_k|, that distance is at most the sum of
///
/// - for ratios other than s_k: |bend of r - s_k| psi_k high + |twist of r - s_k| |phi_k| wide at
///   rest, and for the joints i applied before: |r - s_k| t_k r_i t_i far;
/// - for the chord Q_k z = z + s (D_k z - z) in place of the arc P_k(s) z: s (1 - s) / 2 t_k^2 far,
///   since the arc's second derivative is at most t_k^2 far; the Q do not increase distances;
/// - for the sum of s_k (G_k x - G_parent x) in place of the product of all Q: that has D_i fully
///   above k (u = 1), and not at all in another branch (u = 0), so s_k |s_i - u| t_i t_k high for
///   each pair.
///
/// In all pairs t_i t_k <= (t_i^2 + t_k^2) / 2.
struct BoundsProxy {
    /// A joint at rest, in single precision.
    struct Joint {
        Four centre, twistAxis;
        Four e1, e2; ///< with the twist axis, jointFrame()
        int parent;
        bool isNeeded; ///< by a piece that follows it or a joint below it
    };
    /// A joint that a piece's vertices follow, beyond those that all of them follow fully.
    struct Term {
        std::uint32_t joint;
        bool turns;        ///< whether it rotates the piece by ratios of its own
        float bend, twist; ///< ratios of the piece, where it does
        float bendSpread;  ///< the largest difference of a vertex's ratio from the piece's
        float twistSpread;
        float mostBend; ///< of the vertices
        float mostTwist;
        // The same times `high` and `wide`, where joints applied before do not rotate.
        float bendReach, twistReach;
        float bendMove, twistMove;
        float mostHigh; ///< the largest `high` however they rotate
    };
    struct Piece {
        Four centre, axes[3]; ///< an EllipticCylinder
        std::uint32_t anchor;
        std::uint32_t firstTerm, termCount; ///< innermost (applied first) first
    };

    static constexpr std::size_t kAtOnce = 8; ///< pieces of a Block
    /// One number of each.
    struct alignas(32) Lanes {
        float lane[kAtOnce];
    };
    /// A joint's part in the blended maps of a block's pieces.
    struct Share {
        Lanes weight;      ///< of the joint's map
        Lanes bend, twist; ///< deviation of vertices per radian of the joint's bend and twist
        Lanes square;      ///< and per squared radian of their sum
        std::uint32_t joint;
    };
    /// How far a corrective mode moves the vertices of a block's pieces.
    struct Reach {
        Lanes length;         ///< of the largest shares, in units of Correctives::kUnit
        std::uint32_t weight; ///< weightOf() the mode
    };
    /// The index of a corrective joint's mode.
    static std::uint32_t weightOf(std::uint32_t joint, std::size_t mode) {
        return joint * std::uint32_t{CorrectiveJoint::kMaxModes} + static_cast<std::uint32_t>(mode);
    }
    static constexpr std::size_t kMaxWeights = Correctives::kMaxJoints * CorrectiveJoint::kMaxModes;
    /// Pieces that are processed together; unused lanes repeat the first.
    struct Block {
        Lanes centre[3], axes[3][3]; ///< of the cylinders
        std::uint32_t firstPiece, pieceCount;
        std::uint32_t firstReach, reachCount;
        std::uint32_t firstShare, weighted, shareCount; ///< first those with weights
    };

    /// The most pieces of a skin.
    static constexpr std::size_t kMost = 160;

    std::vector<Joint> joints; ///< the model's
    std::vector<Block> blocks;
    std::vector<Share> shares;
    std::vector<Piece> pieces; ///< in the blocks' order
    std::vector<Term> terms;
    std::vector<Reach> reaches;
    float noTravel; ///< translations up to this may be rounding errors
    float rounding; ///< a bound of a vertex's rounding error, near the origin
};

/// Completes a proxy from a file: it has all but `joints`, and of blocks and pieces no first
/// indices.
///
/// \throw osgSkin::Error where it does not fit the model, or a number is not finite
void completeBoundsProxy(const SkinModel& model, BoundsProxy& proxy);

/// Cuts a model's vertices into pieces; null for a model without vertices.
std::shared_ptr<const BoundsProxy> makeBoundsProxy(const SkinModel& model);

} // namespace osgSkin
