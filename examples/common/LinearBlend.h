// SPDX-License-Identifier: MIT
#pragma once

#include "SkinWeights.h"

namespace compare {

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

} // namespace compare
