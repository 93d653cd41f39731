// SPDX-License-Identifier: MIT
#pragma once

#include "SkinWeights.h"

#include <glm/gtc/quaternion.hpp>

namespace compare {

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

} // namespace compare
