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

/// The weight of one joint at a vertex.
struct JointWeight {
    std::uint32_t joint = 0;
    double weight = 0.0;
};

/// Classic skinning weights, painted or computed, for linear blending and dual quaternions.
///
/// The weights of vertex v are entries[first[v]] up to, not including, entries[first[v + 1]]. They
/// are not negative and sum to 1.
struct SkinWeights {
    std::vector<std::uint32_t> first{0}; ///< size: vertices + 1
    std::vector<JointWeight> entries;

    std::size_t vertexCount() const { return first.size() - 1; }

    /// Appends a vertex. Skips weights of 0.
    void add(const std::vector<JointWeight>& vertex);

    /// \throw std::invalid_argument if the offsets are inconsistent, a joint index is not below
    ///        `joints`, a weight is negative or not finite, or a vertex's weights do not sum to 1
    ///        (tolerance 1e-6)
    void validate(std::size_t joints) const;
};

/// Transforms each point by its own matrix.
/// \throw std::invalid_argument if the counts differ
std::vector<glm::dvec3> transformPoints(const std::vector<glm::dmat4>& matrices,
                                        const std::vector<glm::dvec3>& points);

/// Linear blend skinning, for comparison with osgSkin; not part of the product.
///
/// A vertex is transformed by the weighted mean of its joints' matrices (Magnenat-Thalmann,
/// Laperriere and Thalmann 1988). A mean of rotations is not a rotation, so the skin shrinks: at
/// half weight between two joints that differ by a rotation of theta, a cross-section keeps
/// cos^2(theta / 2) of its area under a twist, and cos(theta / 2) under a bend.
///
/// \param weights of the vertices
/// \param skinning G_j = bone matrix * inverse bind matrix, in rest space, one per joint
/// \return one matrix per vertex
/// \throw std::invalid_argument in the cases of SkinWeights::validate()
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

/// Converts a rigid matrix to a dual quaternion.
/// \throw std::invalid_argument if the matrix is not finite, scales, shears or mirrors (tolerance
///        1e-6)
DualQuaternion toDualQuaternion(const glm::dmat4& rigid);

/// Dual quaternion skinning (Kavan, Collins, Zara and O'Sullivan 2008, DLB), for comparison with
/// osgSkin; not part of the product.
///
/// A vertex is transformed by the normalised weighted sum of its joints' dual quaternions. q and -q
/// are the same rotation. The sign closer to the joint of largest weight is used, so that blending
/// takes the shorter path.
///
/// \param weights of the vertices
/// \param skinning G_j = bone matrix * inverse bind matrix, in rest space, one per joint; rigid
/// \return one rigid matrix per vertex
/// \throw std::invalid_argument in the cases of SkinWeights::validate() and toDualQuaternion()
std::vector<glm::dmat4> dualQuaternionBlendMatrices(const SkinWeights& weights,
                                                    const std::vector<glm::dmat4>& skinning);

/// The posed positions of `rest`, one per vertex of `weights`.
std::vector<glm::dvec3> dualQuaternionBlend(const std::vector<glm::dvec3>& rest,
                                            const SkinWeights& weights,
                                            const std::vector<glm::dmat4>& skinning);

using Points = std::vector<glm::dvec3>;

/// Volume of a closed mesh whose faces point outward; inverted folds are subtracted.
/// \param points positions of the vertices
/// \param triangles three vertex indices each
double enclosedVolume(const Points& points, const std::vector<std::uint32_t>& triangles);

/// Length of the vector area of a closed loop of vertices. For a planar loop this is its area.
double loopArea(const Points& points, const std::vector<std::uint32_t>& loop);

using Edge = std::array<std::uint32_t, 2>;

/// The unique edges of the faces, sorted; each is (lower index, higher index).
/// \param sizes vertex count of each face, see osgSkin::SkinMesh
/// \param vertices vertex indices of the faces, one face after the other
std::vector<Edge> faceEdges(const std::vector<std::uint32_t>& sizes,
                            const std::vector<std::uint32_t>& vertices);

/// Statistics of the edge strain l'/l - 1, over all edges whose rest length is not 0.
struct EdgeStrain {
    double rms = 0.0;
    double percentile999 = 0.0; ///< of l'/l
    double largest = 0.0;       ///< of l'/l
};
EdgeStrain edgeStrain(const Points& rest, const Points& posed, const std::vector<Edge>& edges);

/// The ends of a bone.
struct Segment {
    glm::dvec3 from, to;
};

/// Maximum over `vertices` of the distance to the nearest bone, posed divided by rest.
double bulge(const Points& rest, const Points& posed, const std::vector<std::uint32_t>& vertices,
             const std::vector<Segment>& restBones, const std::vector<Segment>& posedBones);

} // namespace compare

#endif
