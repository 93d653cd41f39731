// SPDX-License-Identifier: GPL-3.0-or-later
#include "ElasticFigures.h"

#include <elastic/SolveElastic.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace quality {
namespace {

using osgSkin::CorrectiveJoint;

/// Angles at which a ball joint is looked at between the directions that are sampled, degrees.
constexpr double kBetweenAngles[] = {45.0, 75.0};
constexpr int kDirections = 8;

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

const CorrectiveJoint& correctivesOf(const Subject& shaped, std::size_t joint) {
    for (const CorrectiveJoint& each : shaped.binding.correctives.joints)
        if (each.joint == joint) return each;
    throw std::runtime_error("joint " + shaped.rig.joints[joint].name + " has no shapes");
}

double angleOf(double sineOfHalf) {
    return 2.0 * std::asin(sineOfHalf);
}

/// Midway between a hinge's samples of the main direction.
std::vector<glm::dquat> betweenHinges(const std::vector<glm::dquat>& samples,
                                      const glm::dvec3& axis) {
    std::vector<double> angles{0.0};
    for (const glm::dquat& q : samples)
        if (glm::length(glm::cross(glm::dvec3(q.x, q.y, q.z), axis)) < 1e-9)
            angles.push_back(angleOf(glm::dot(glm::dvec3(q.x, q.y, q.z), axis)));
    std::sort(angles.begin(), angles.end());
    std::vector<glm::dquat> between;
    for (std::size_t i = 1; i < angles.size(); ++i)
        between.push_back(glm::angleAxis(0.5 * (angles[i - 1] + angles[i]), axis));
    return between;
}

/// In directions between those of the samples.
std::vector<glm::dquat> betweenBalls(const glm::dvec3& axis, const glm::dvec3& pole) {
    std::vector<glm::dquat> between;
    for (int i = 0; i < kDirections; ++i)
        for (const double angle : kBetweenAngles)
            between.push_back(glm::angleAxis(
                glm::radians(angle),
                glm::angleAxis(2.0 * glm::pi<double>() * (i + 0.5) / kDirections, pole) * axis));
    return between;
}

void addBones(const Subject& subject, int joint, std::vector<osgSkin::ElasticBone>& bones) {
    const auto& joints = subject.rig.joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (joints[j].tip)
            bones.push_back({joints[j].centre, *joints[j].tip,
                             subject.rig.isInSubtree(static_cast<int>(j), joint)});
        if (joints[j].parent < 0) continue;
        bones.push_back({joints[static_cast<std::size_t>(joints[j].parent)].centre,
                         joints[j].centre, subject.rig.isInSubtree(joints[j].parent, joint)});
    }
}

} // namespace

ReferenceJoint referenceJointOf(const Subject& shaped, const std::string& name) {
    const int found = shaped.joint(name);
    if (found < 0) throw std::runtime_error("there is no joint " + name);
    const auto index = static_cast<std::size_t>(found);
    const CorrectiveJoint& functions = correctivesOf(shaped, index);
    ReferenceJoint reference;
    osgSkin::ElasticJoint& joint = reference.joint;
    joint.name = name;
    joint.centre = shaped.rig.joints[index].centre;
    joint.ratios.assign(shaped.rest.size(), 0.0);
    for (std::size_t v = 0; v < shaped.rest.size(); ++v)
        for (std::size_t i = shaped.binding.firstInfluence[v];
             i < shaped.binding.firstInfluence[v + 1]; ++i)
            if (shaped.binding.influences[i].joint == index)
                joint.ratios[v] = double(shaped.binding.influences[i].bend);
    addBones(shaped, found, joint.bones);
    const osgSkin::BoundJoint& bound = shaped.binding.joints[index];
    joint.radius = radiusAt(shaped, joint.centre, bound.boneAxis, joint.ratios);
    joint.hinge = functions.basis == CorrectiveJoint::Basis::Hinge;

    std::vector<glm::dquat> between;
    if (joint.hinge) {
        osgSkin::HingeRange range;
        range.axis = functions.axis;
        range.leastFlexion = angleOf(functions.low.x);
        range.mostFlexion = angleOf(functions.high.x);
        joint.samples = osgSkin::hingeSamples(range, bound.twistAxis);
        between = betweenHinges(joint.samples, functions.axis);
    } else {
        joint.samples = osgSkin::ballSamples(bound.twistAxis, angleOf(functions.high.x));
        between = betweenBalls(glm::normalize(glm::axis(joint.samples.front())), bound.twistAxis);
    }
    reference.fitted = joint.samples.size();
    joint.samples.insert(joint.samples.end(), between.begin(), between.end());
    return reference;
}

} // namespace quality
