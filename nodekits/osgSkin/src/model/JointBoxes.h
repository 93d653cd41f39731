// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/GlmTypes>
#include <osgSkin/SkinModel>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Boxes of rest vertices in joints' frames, from which the bounds of a pose are computed.
///
/// A box contains vertices that mostly move with one joint A: they take at least half of the
/// rotations of A and of the joints above it (s = 1), and little of all others (s = 0). It moves
/// with A, by the skinning matrix G_A, and is enlarged by the largest distance of a vertex from G_A
/// x. That is bounded as follows.
///
/// A vertex x becomes P_1 ... P_n x, where P_k is the transform of the k-th joint of the product
/// by the vertex's ratios. G_A is the same product with S_k, the full transform where s = 1 and the
/// identity where s = 0. Replacing one factor after the other,
///
///   P_1 ... P_n x - G_A x = sum over k of P_1 ... P_k-1 (P_k z_k - S_k z_k), z_k = S_k+1 ... S_n
///   x.
///
/// P_1 ... P_k-1 are rotations, which keep lengths. P_k and S_k rotate about the same two axes
/// through the joint's centre, by angles that differ by |ratio - s| of the joint's bend psi and
/// twist phi. A chord is no longer than its arc, so with d the distance of z_k from the centre, and
/// a <= d that from the twist axis,
///
///   |P_k z_k - S_k z_k| <= |bend ratio - s| psi d + |twist ratio - s| |phi| a.
///
/// At rest, d and a are those of x. In a pose, joints with s = 1 after the k-th have moved x to
/// z_k = G_m^-1 G_A x, where m is the last joint up to the k-th with s = 1: d and a grow by at most
/// |z_k - x|. That is the term of second order, and there are no others.
///
/// Scale and translation of a joint come in with the bend ratio. A translation t and a scale g add
/// |bend ratio - s| (|t| + |g - 1| d), and P_1 ... P_k-1 multiply lengths by their scales.
/// Correctives move x at rest, so that their lengths are multiplied by all scales.
struct JointBoxes {
    /// A joint of a box or a term, or a parent of one.
    struct Joint {
        std::uint32_t joint; ///< of the model
        int parent;          ///< index in `joints`, before this one; -1 for the root
        glm::dmat3 frame;    ///< jointFrame(): the axes of its boxes
        std::uint32_t firstBox, boxCount;
    };
    struct Box {
        glm::dvec3 centre, half;            ///< of its vertices at rest, in the joint's frame
        std::uint32_t firstTerm, termCount; ///< in the order of the product
        std::uint32_t firstReach, reachCount;
    };
    /// A joint for which ratios of a box's vertices differ from s.
    struct Term {
        std::uint32_t joint; ///< k, index in `joints`
        std::uint32_t from;  ///< m, index in `joints`
        bool isFull;         ///< s = 1
        double bend, twist;  ///< largest |ratio - s|
        double bendReach;    ///< largest |bend ratio - s| d, at rest
        double twistReach;   ///< largest |twist ratio - s| a, at rest
    };
    /// The correctives of a joint that move vertices of a box.
    struct Reach {
        std::uint32_t joint; ///< in Correctives::joints
        double share;        ///< longest shares relative to `modeReach`
    };

    /// \param model with all its other data, and at least one vertex
    /// \throw osgSkin::Error where a vertex has more than kMaxTerms terms
    explicit JointBoxes(const SkinModel& model);

    /// The most terms of a vertex: far more than a body has.
    static constexpr std::size_t kMaxTerms = 1024;

    std::vector<Joint> joints;
    std::vector<Box> boxes;
    std::vector<Term> terms;
    std::vector<Reach> reaches;
    /// The longest shares of each corrective mode: kMaxModes for each of Correctives::joints.
    std::vector<double> modeReach;
    double rounding; ///< a bound of vertices' rounding errors near the origin
};

} // namespace osgSkin
