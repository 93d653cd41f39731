// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace mannequin {

/// Rest position of a joint of the mannequin's skeleton.
/// \throw std::out_of_range if the skeleton has no such joint
glm::dvec3 jointCentre(const std::string& name);

/// A limb's cross-section, at a fraction of one of its bones.
struct LimbSection {
    int bone;        ///< index in the chain
    double fraction; ///< of the bone's length; may lie slightly outside 0..1
    double shiftFront, shiftInner;
    double front, back, inner, outer; ///< radii
};

/// A solid around a chain of joints. `front` is the component of +Z orthogonal to the chain.
Loft limbLoft(const std::vector<glm::dvec3>& chain, const std::vector<LimbSection>& sections);

} // namespace mannequin
