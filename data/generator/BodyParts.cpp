// SPDX-License-Identifier: MIT
#include "BodyParts.h"
#include "MannequinSkeleton.h"

#include <glm/geometric.hpp>

#include <stdexcept>

namespace mannequin {

glm::dvec3 jointCentre(const std::string& name) {
    static const std::vector<RestJoint> joints = restSkeleton();
    for (const RestJoint& joint : joints)
        if (joint.name == name) return joint.centre;
    throw std::out_of_range("no joint " + name);
}

Loft limbLoft(const std::vector<glm::dvec3>& chain, const std::vector<LimbSection>& sections) {
    const LoftFrame frame = LoftFrame::make(chain.front(), chain.back() - chain.front(), {0, 0, 1});
    std::vector<LoftSection> loft;
    for (const LimbSection& s : sections) {
        const auto bone = static_cast<std::size_t>(s.bone);
        const glm::dvec3 centre =
            chain[bone] + (chain[bone + 1] - chain[bone]) * s.fraction - frame.origin;
        loft.push_back({glm::dot(centre, frame.axis), glm::dot(centre, frame.u) + s.shiftFront,
                        glm::dot(centre, frame.v) + s.shiftInner, s.front, s.back, s.inner, s.outer,
                        2.1});
    }
    return {frame, loft};
}

} // namespace mannequin
