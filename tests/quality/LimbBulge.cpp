// SPDX-License-Identifier: MIT
#include "LimbBulge.h"

#include <set>

namespace quality {

LimbBulge::LimbBulge(const Subject& subject) : _subject(subject) {
    std::set<std::uint32_t> limbs;
    for (const std::string side : {"Left", "Right"})
        for (const char* name : {"Arm", "ForeArm", "UpLeg", "Leg"})
            if (const int joint = subject.joint(side + name); joint >= 0)
                limbs.insert(static_cast<std::uint32_t>(joint));
    for (std::uint32_t v = 0; v < subject.rest.size(); ++v)
        if (limbs.count(subject.dominantJoint(v)) > 0) _vertices.push_back(v);
    const auto& joints = subject.rig.joints;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        const auto parent = static_cast<std::size_t>(joints[j].parent);
        _bones.push_back({joints[parent].centre, joints[j].centre});
        _jointOfBone.push_back(parent);
    }
}

double LimbBulge::of(const compare::Points& posed, const std::vector<glm::dmat4>& skinning) const {
    std::vector<compare::Segment> bones;
    for (std::size_t b = 0; b < _bones.size(); ++b) {
        const glm::dmat4& moved = skinning[_jointOfBone[b]];
        bones.push_back({glm::dvec3(moved * glm::dvec4(_bones[b].from, 1.0)),
                         glm::dvec3(moved * glm::dvec4(_bones[b].to, 1.0))});
    }
    return compare::bulge(_subject.rest, posed, _vertices, _bones, bones);
}

} // namespace quality
