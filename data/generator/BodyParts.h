// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace mannequin {

/// Rest centre of a joint of the mannequin's skeleton; throws std::out_of_range for another name.
glm::dvec3 jointCentre(const std::string& name);

/// A limb's cross-section, placed by a fraction of one of its bones.
struct LimbSection {
    int bone;        ///< 0 for the first of the chain
    double fraction; ///< of the bone's length; may leave 0..1 by a little
    double shiftFront, shiftInner;
    double front, back, inner, outer; ///< radii
};

/// Solid about a chain of joints; `front` is the part of +Z that is orthogonal to the chain.
Loft limbLoft(const std::vector<glm::dvec3>& chain, const std::vector<LimbSection>& sections);

} // namespace mannequin
