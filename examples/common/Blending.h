// SPDX-License-Identifier: MIT
#ifndef COMMON_BLENDING_H
#define COMMON_BLENDING_H

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace compare {

/// A vertex's share in one joint's matrix.
struct JointWeight {
    std::uint32_t joint = 0;
    double weight = 0.0;
};

/// Classic skinning weights, as painted or computed: what linear blending and dual quaternions
/// need.
///
/// Vertex v owns entries[first[v]] up to entries[first[v + 1]]. Weights are at least 0 and sum
/// to 1.
struct SkinWeights {
    std::vector<std::uint32_t> first{0}; ///< size: vertices + 1
    std::vector<JointWeight> entries;

    std::size_t vertexCount() const { return first.size() - 1; }

    /// Adds a vertex after the ones there are. Weights of 0 are left out.
    void add(const std::vector<JointWeight>& vertex);

    /// \throw std::invalid_argument where offsets do not fit, a joint is not below `joints`, a weight
    ///        is negative or not finite, or a vertex's weights do not sum to 1 (to 1e-6)
    void validate(std::size_t joints) const;
};

/// `points` each moved by its own matrix.
/// \throw std::invalid_argument where the counts differ
std::vector<glm::dvec3> transformPoints(const std::vector<glm::dmat4>& matrices,
                                        const std::vector<glm::dvec3>& points);

/// Linear blend skinning, the peer that osgSkin is measured against; no part of the product.
///
/// A vertex moves by the weighted mean of its joints' matrices (Magnenat-Thalmann, Laperriere and
/// Thalmann 1988). A mean of rotations is no rotation, so it shrinks: at half weight between two
/// frames turned by theta against each other, a cross-section keeps cos^2(theta / 2) of its area
/// where the turn is a twist, and cos(theta / 2) where it is a bend.
///
/// \param skinning G_j = bone matrix * inverse bind matrix, in rest space, one per joint
/// \return one matrix per vertex
/// \throw std::invalid_argument where SkinWeights::validate() would
std::vector<glm::dmat4> linearBlendMatrices(const SkinWeights& weights,
                                            const std::vector<glm::dmat4>& skinning);

/// The posed positions of `rest`, one per vertex of `weights`.
std::vector<glm::dvec3> linearBlend(const std::vector<glm::dvec3>& rest, const SkinWeights& weights,
                                    const std::vector<glm::dmat4>& skinning);

/// A rotation followed by a translation: real + epsilon * dual.
struct DualQuaternion {
    glm::dquat real{1.0, 0.0, 0.0, 0.0}; ///< the rotation, unit length
    glm::dquat dual{0.0, 0.0, 0.0, 0.0}; ///< half the translation times the rotation
};

/// The dual quaternion of a rigid matrix.
/// \throw std::invalid_argument where the matrix is not finite, scales, shears or mirrors (to 1e-6)
DualQuaternion toDualQuaternion(const glm::dmat4& rigid);

/// Dual quaternion skinning (Kavan, Collins, Zara and O'Sullivan 2008, DLB), the other peer that
/// osgSkin is measured against; no part of the product.
///
/// A vertex moves by the weighted sum of its joints' dual quaternions, normalised. q and -q are the
/// same rotation: each is taken with the sign nearer to that of the vertex's heaviest joint, so
/// that it goes the short way round.
///
/// \param skinning G_j = bone matrix * inverse bind matrix, in rest space, one per joint; rigid
/// \return one rigid matrix per vertex
/// \throw std::invalid_argument where SkinWeights::validate() or toDualQuaternion() would
std::vector<glm::dmat4> dualQuaternionBlendMatrices(const SkinWeights& weights,
                                                    const std::vector<glm::dmat4>& skinning);

/// The posed positions of `rest`, one per vertex of `weights`.
std::vector<glm::dvec3> dualQuaternionBlend(const std::vector<glm::dvec3>& rest,
                                            const SkinWeights& weights,
                                            const std::vector<glm::dmat4>& skinning);

using Points = std::vector<glm::dvec3>;

/// Volume inside a closed, outward-facing mesh; folds count against it.
/// \param triangles three vertex indices each
double enclosedVolume(const Points& points, const std::vector<std::uint32_t>& triangles);

/// Area of the surface that a closed loop of vertices spans: the length of its vector area, which
/// for a plane loop is the area itself.
double loopArea(const Points& points, const std::vector<std::uint32_t>& loop);

using Edge = std::array<std::uint32_t, 2>;

/// Each edge of the faces once, as (lower index, higher index), sorted.
/// \param sizes of the faces, as osgSkin::SkinMesh keeps them
/// \param vertices of the faces, one face after the other
std::vector<Edge> faceEdges(const std::vector<std::uint32_t>& sizes,
                            const std::vector<std::uint32_t>& vertices);

/// How edges change length, l'/l - 1, over all edges that have a length at rest.
struct EdgeStrain {
    double rms = 0.0;
    double percentile999 = 0.0; ///< of l'/l
    double largest = 0.0;       ///< of l'/l
};
EdgeStrain edgeStrain(const Points& rest, const Points& posed, const std::vector<Edge>& edges);

/// A bone from one end to the other.
struct Segment {
    glm::dvec3 from, to;
};

/// Largest distance to the nearest posed bone over that to the nearest rest bone, over `vertices`.
double bulge(const Points& rest, const Points& posed, const std::vector<std::uint32_t>& vertices,
             const std::vector<Segment>& restBones, const std::vector<Segment>& posedBones);

} // namespace compare

#endif
