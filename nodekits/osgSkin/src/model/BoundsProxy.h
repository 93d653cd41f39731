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
///
/// Most pieces are well inside the box, which a cheaper bound shows, several at once: that their
/// vertices are not far from where linear blending puts them, by one ratio s_k of the piece a
/// joint (of bends: those take vertices further than twists do). With `far` what `high` cannot
/// exceed however joints turn, and t_k = psi_k + |phi_k|, they stray from that by
///
/// - other ratios than s_k: |bend of r - s_k| psi_k high + |twist of r - s_k| |phi_k| wide at rest,
///   and by what the joints i applied before move them: |r - s_k| t_k r_i t_i far;
/// - instead of the arc P_k(s) z, its chord Q_k z = z + s (D_k z - z): s (1 - s) / 2 t_k^2 far, as
///   of any curve whose second derivative is at most t_k^2 far; the Q keep distances from growing;
/// - instead of the product of all Q, the sum of s_k (G_k x - G_parent x), which has D_i wholly
///   above k (u = 1; or not at all, u = 0, in another branch): s_k |s_i - u| t_i t_k high for each
///   pair.
///
/// In all pairs t_i t_k <= (t_i^2 + t_k^2) / 2.
struct BoundsProxy {
    /// A joint at rest, in single precision.
    struct Joint {
        Four centre, twistAxis;
        Four e1, e2; ///< with the twist axis, jointFrame()
        int parent;
        bool isNeeded; ///< a piece follows it, or a joint below it
    };
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
        float mostHigh; ///< the largest `high` whatever they do, but move and scale
    };
    struct Piece {
        Four centre, axes[3]; ///< an EllipticCylinder
        std::uint32_t anchor;
        std::uint32_t firstTerm, termCount; ///< innermost (applied first) first
    };

    static constexpr std::size_t kAtOnce = 8; ///< pieces of a Block
    /// A number of each of them.
    struct alignas(32) Lanes {
        float lane[kAtOnce];
    };
    /// What a block's pieces have of one joint when they are blended.
    struct Share {
        Lanes weight;      ///< of the joint's map in theirs
        Lanes bend, twist; ///< how far vertices stray, a radian of the joint's bend and twist
        Lanes square;      ///< and a squared radian of their sum
        std::uint32_t joint;
    };
    /// How far a mode of correctives takes a block's pieces.
    struct Reach {
        Lanes length;         ///< of the largest shares of a piece, as they are held
        std::uint32_t weight; ///< which of the modes: weightOf()
    };
    /// Of a joint of the correctives' and one of its modes.
    static std::uint32_t weightOf(std::uint32_t joint, std::size_t mode) {
        return joint * std::uint32_t{CorrectiveJoint::kMostModes} +
               static_cast<std::uint32_t>(mode);
    }
    static constexpr std::size_t kMostWeights =
        Correctives::kMostJoints * CorrectiveJoint::kMostModes;
    /// Pieces that are worked on at once; missing ones are the first again.
    struct Block {
        Lanes centre[3], axes[3][3]; ///< of the cylinders
        std::uint32_t firstPiece, pieceCount;
        std::uint32_t firstReach, reachCount;
        std::uint32_t firstShare, weighted, shareCount; ///< first those with weights
    };

    /// Pieces that a skin is cut into at most.
    static constexpr std::size_t kMost = 160;

    std::vector<Joint> joints; ///< the model's
    std::vector<Block> blocks;
    std::vector<Share> shares;
    std::vector<Piece> pieces; ///< in the blocks' order
    std::vector<Term> terms;
    std::vector<Reach> reaches;
    float noTravel; ///< a joint's translation up to this may be a rounding error
    float rounding; ///< what those may put a vertex off by, near the origin
};

/// Cuts a model's vertices into pieces; null for a model without vertices.
std::shared_ptr<const BoundsProxy> makeBoundsProxy(const SkinModel& model);

} // namespace osgSkin
