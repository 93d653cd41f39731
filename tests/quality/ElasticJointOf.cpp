// SPDX-License-Identifier: GPL-3.0-or-later
#include "ElasticFigures.h"

#include <elastic/ElasticSamples.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace quality {
namespace {

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Median distance from the bone's line to the edges across which the ratio passes one half.
double radiusAt(const Subject& subject, const glm::dvec3& centre, const glm::dvec3& axis,
                const std::vector<double>& ratios) {
    std::vector<double> radii;
    for (const auto& [a, b] : subject.edges) {
        if ((ratios[a] > 0.5) == (ratios[b] > 0.5)) continue;
        const glm::dvec3 d = 0.5 * (subject.rest[a] + subject.rest[b]) - centre;
        radii.push_back(glm::length(d - axis * glm::dot(d, axis)));
    }
    if (radii.empty()) throw std::runtime_error("no skin follows a joint halfway");
    std::nth_element(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2),
                     radii.end());
    return radii[radii.size() / 2];
}

} // namespace

osgSkin::ElasticJoint elasticJointOf(const Subject& subject, const std::string& name) {
    const int found = subject.joint(name);
    if (found < 0) throw std::runtime_error("there is no joint " + name);
    const auto index = static_cast<std::size_t>(found);
    const auto& joints = subject.rig.joints;
    osgSkin::ElasticJoint joint;
    joint.name = name;
    joint.centre = joints[index].centre;
    joint.ratios.assign(subject.rest.size(), 0.0);
    for (std::size_t v = 0; v < subject.rest.size(); ++v)
        for (std::size_t i = subject.binding.firstInfluence[v];
             i < subject.binding.firstInfluence[v + 1]; ++i)
            if (subject.binding.influences[i].joint == index)
                joint.ratios[v] = double(subject.binding.influences[i].bend);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (joints[j].tip)
            joint.bones.push_back({joints[j].centre, *joints[j].tip,
                                   subject.rig.isInSubtree(static_cast<int>(j), found)});
        if (joints[j].parent < 0) continue;
        joint.bones.push_back({joints[static_cast<std::size_t>(joints[j].parent)].centre,
                               joints[j].centre, subject.rig.isInSubtree(joints[j].parent, found)});
    }
    const glm::dvec3 pole = subject.binding.joints[index].boneAxis;
    joint.radius = radiusAt(subject, joint.centre, pole, joint.ratios);

    const bool elbow = endsWith(name, "ForeArm"),
               knee = !elbow && endsWith(name, "Leg") && !endsWith(name, "UpLeg");
    joint.hinge = elbow || knee;
    if (joint.hinge) {
        const glm::dvec3 above = glm::normalize(
            joint.centre - joints[static_cast<std::size_t>(joints[index].parent)].centre);
        osgSkin::HingeRange range;
        range.restFlexion = std::acos(std::clamp(glm::dot(above, pole), -1.0, 1.0));
        // A straight knee does not say which way it bends: shins go backwards.
        range.axis = glm::cross(above, pole);
        if (knee && range.restFlexion < glm::radians(15.0)) {
            range.axis = glm::cross(above, glm::dvec3(0, 0, -1));
            range.restFlexion = 0.0;
        }
        range.axis = glm::normalize(range.axis);
        range.mostFlexion = glm::radians(139.0);
        joint.samples = osgSkin::hingeSamples(range, pole);
    } else {
        joint.samples = osgSkin::ballSamples(pole, glm::radians(90.0));
    }
    return joint;
}

} // namespace quality
