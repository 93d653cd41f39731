// SPDX-License-Identifier: MIT
#include "Rigidity.h"

#include <glm/geometric.hpp>

namespace quality {
namespace {

double bendRatio(const osgSkin::Binding& binding, std::size_t vertex, std::size_t joint) {
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i)
        if (binding.influences[i].joint == joint)
            return static_cast<double>(binding.influences[i].bend);
    return 0.0;
}

/// What a ratio is to painted weights: the share of the joint and all that hangs on it.
double paintedRatio(const Subject& subject, std::size_t vertex, int joint) {
    double sum = 0.0;
    for (std::uint32_t i = subject.weights.first[vertex]; i < subject.weights.first[vertex + 1];
         ++i) {
        const compare::JointWeight& entry = subject.weights.entries[i];
        if (subject.rig.isInSubtree(static_cast<int>(entry.joint), joint)) sum += entry.weight;
    }
    return sum;
}

LimbRigidity measure(const Subject& subject, int own, int next) {
    const auto a = static_cast<std::size_t>(own), b = static_cast<std::size_t>(next);
    LimbRigidity limb;
    limb.limb = subject.rig.joints[a].name;
    const glm::dvec3 from = subject.rig.joints[a].centre;
    const glm::dvec3 way = subject.rig.joints[b].centre - from;
    for (std::size_t v = 0; v < subject.rest.size(); ++v) {
        if (subject.dominantJoint(v) != a) continue;
        const double along = glm::dot(subject.rest[v] - from, way) / glm::dot(way, way);
        if (along < 1.0 / 3.0 || along > 2.0 / 3.0) continue;
        ++limb.vertices;
        limb.own += bendRatio(subject.binding, v, a);
        limb.next += bendRatio(subject.binding, v, b);
        limb.paintedOwn += paintedRatio(subject, v, own);
        limb.paintedNext += paintedRatio(subject, v, next);
    }
    const auto count = static_cast<double>(limb.vertices);
    for (double* sum : {&limb.own, &limb.next, &limb.paintedOwn, &limb.paintedNext}) *sum /= count;
    return limb;
}

} // namespace

std::vector<LimbRigidity> measureRigidity(const Subject& subject) {
    constexpr const char* kBones[][2] = {
        {"Arm", "ForeArm"}, {"ForeArm", "Hand"}, {"UpLeg", "Leg"}, {"Leg", "Foot"}};
    std::vector<LimbRigidity> limbs;
    for (const auto& [own, next] : kBones)
        for (const std::string side : {"Left", "Right"}) {
            const int a = subject.joint(side + own), b = subject.joint(side + next);
            if (a >= 0 && b >= 0) limbs.push_back(measure(subject, a, b));
            if (a >= 0 && b >= 0 && limbs.back().vertices == 0) limbs.pop_back();
        }
    return limbs;
}

} // namespace quality
