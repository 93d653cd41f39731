// SPDX-License-Identifier: MIT
#include "JointRanges.h"

#include <osgSkin/Correctives>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace bake {

namespace {

using osgSkin::CorrectiveJoint;
using osgSkin::JointMap;

constexpr double kBend = glm::pi<double>() / 3.0;  ///< of joints without shapes
constexpr double kTwist = glm::pi<double>() / 3.0; ///< to each side
constexpr std::size_t kTogether = 16;              ///< poses of all joints
constexpr double kShare = 0.5;                     ///< of their ranges, at most

/// How far a joint bends about two axes across its bone, radians.
struct JointRange {
    glm::dvec3 twistAxis, axis, other;
    double low = -kBend, high = kBend; ///< about `axis`
    double side = kBend;               ///< about `other`, both ways; 0 for hinges
};

std::vector<JointRange> rangesOf(const osgSkin::Binding& binding) {
    std::vector<JointRange> result;
    for (const osgSkin::BoundJoint& joint : binding.joints) {
        const glm::dvec3 w = joint.twistAxis;
        const glm::dvec3 any = std::abs(w.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        JointRange range{w, glm::normalize(glm::cross(w, any)), {}};
        range.other = glm::cross(w, range.axis);
        result.push_back(range);
    }
    const auto angle = [](double sineOfHalf) {
        return 2.0 * std::asin(std::clamp(sineOfHalf, -1.0, 1.0));
    };
    for (const CorrectiveJoint& shaped : binding.correctives.joints) {
        if (shaped.basis == CorrectiveJoint::Basis::Input) continue;
        JointRange& range = result[shaped.joint];
        const bool isHinge = shaped.basis == CorrectiveJoint::Basis::Hinge ||
                             shaped.basis == CorrectiveJoint::Basis::TurnedHinge;
        range.axis = shaped.axis;
        range.other = glm::cross(range.twistAxis, shaped.axis);
        range.low = angle(shaped.low.x);
        range.high = angle(shaped.high.x);
        range.side = isHinge ? 0.0 : angle(shaped.high.y);
    }
    return result;
}

} // namespace

std::vector<osgSkin::Pose> jointRanges(const osgSkin::Binding& binding) {
    const std::vector<JointRange> ranges = rangesOf(binding);
    std::vector<JointMap> own(ranges.size());
    std::vector<osgSkin::Pose> result;
    const auto rotate = [&](std::size_t j, const glm::dquat& q) {
        const glm::dvec3& centre = binding.joints[j].centre;
        own[j] = {q, centre - q * centre, 1.0};
    };
    const auto add = [&] {
        result.emplace_back(binding.joints, binding.correctives.inputs.size());
        result.back().set(own.data(), own.size());
    };
    for (std::size_t j = 1; j < ranges.size(); ++j) {
        const JointRange& range = ranges[j];
        const auto bend = [&](double angle, const glm::dvec3& axis) {
            if (angle == 0.0) return;
            rotate(j, glm::angleAxis(angle, axis));
            add();
        };
        for (const double share : {0.5, 1.0}) {
            for (const double angle : {range.low, range.high}) bend(share * angle, range.axis);
            for (const double side : {-range.side, range.side}) bend(share * side, range.other);
        }
        for (const double twist : {-kTwist, kTwist}) bend(twist, range.twistAxis);
        own[j] = {};
    }
    std::mt19937 random; // its numbers are the same everywhere
    const auto upTo = [&](double low, double high) {
        return low + (high - low) * double(random()) / double(std::mt19937::max());
    };
    for (std::size_t k = 0; k < kTogether; ++k) {
        for (std::size_t j = 1; j < ranges.size(); ++j) {
            const JointRange& range = ranges[j];
            const glm::dvec3 bend = upTo(range.low, range.high) * range.axis +
                                    upTo(-range.side, range.side) * range.other;
            const double angle = glm::length(bend);
            const glm::dquat twist =
                glm::angleAxis(kShare * upTo(-kTwist, kTwist), range.twistAxis);
            rotate(j, angle > 0.0 ? glm::angleAxis(kShare * angle, bend / angle) * twist : twist);
        }
        add();
    }
    return result;
}

} // namespace bake
