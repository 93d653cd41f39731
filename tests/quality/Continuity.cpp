// SPDX-License-Identifier: MIT
#include "Continuity.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace quality {
namespace {

/// Skin nearer to the axis than this share of the body's size hardly moves, and single precision
/// would show more than the sweep.
constexpr double kAxisShare = 0.005;

/// Length of the rigid arc's chord for a degree, for each vertex; 0 for those to pass over.
std::vector<double> rigidSteps(const Subject& subject, const glm::dvec3& centre,
                               const glm::dvec3& axis) {
    const double least = kAxisShare * subject.mesh.size();
    std::vector<double> steps;
    for (const glm::dvec3& p : subject.rest) {
        const double radius = glm::length(glm::cross(axis, p - centre));
        steps.push_back(radius > least ? 2.0 * std::sin(glm::radians(0.5)) * radius : 0.0);
    }
    return steps;
}

void sweep(const Subject& subject, std::size_t joint, const glm::dvec3& axis,
           PerMethod<Sweep>& result) {
    const std::vector<double> rigid =
        rigidSteps(subject, subject.binding.joints[joint].centre, axis);
    PerMethod<compare::Points> last;
    for (int degrees = -179; degrees <= 179; ++degrees) {
        const auto skinning =
            singleTurn(subject, joint, axis, glm::radians(static_cast<double>(degrees)));
        for (const Method method : kMethods) {
            compare::Points posed = deform(subject, method, skinning);
            double worst = 0.0;
            for (std::size_t v = 0; v < last[method].size(); ++v)
                if (rigid[v] > 0.0)
                    worst = std::max(worst, glm::distance(posed[v], last[method][v]) / rigid[v]);
            if (worst > result[method].worst)
                result[method] = {worst, subject.rig.joints[joint].name};
            last[method] = std::move(posed);
        }
    }
}

/// The same of ours alone, to `result` where it is worse.
void sweepOurs(const Subject& subject, std::size_t joint, const glm::dvec3& axis, Sweep& result) {
    const std::vector<double> rigid =
        rigidSteps(subject, subject.binding.joints[joint].centre, axis);
    compare::Points last;
    for (int degrees = -179; degrees <= 179; ++degrees) {
        compare::Points posed =
            deform(subject, Method::Ours,
                   singleTurn(subject, joint, axis, glm::radians(static_cast<double>(degrees))));
        for (std::size_t v = 0; v < last.size(); ++v) {
            if (!(rigid[v] > 0.0)) continue;
            const double step = glm::distance(posed[v], last[v]) / rigid[v];
            if (step > result.worst) result = {step, subject.rig.joints[joint].name};
        }
        last = std::move(posed);
    }
}

} // namespace

Continuity measureContinuity(const Subject& subject) {
    Continuity result;
    for (std::size_t j = 1; j < subject.rig.joints.size(); ++j) {
        const glm::dvec3& pole = subject.binding.joints[j].twistAxis;
        const glm::dvec3 side = osgSkin::anyPerpendicular(pole);
        sweep(subject, j, side, result.bend);
        sweep(subject, j, glm::cross(pole, side), result.bend);
        sweep(subject, j, pole, result.twist);
    }
    return result;
}

Sweep measureShapedBends(const Subject& subject) {
    Sweep result;
    for (const osgSkin::CorrectiveJoint& shaped : subject.binding.correctives.joints) {
        const glm::dvec3& pole = subject.binding.joints[shaped.joint].twistAxis;
        const glm::dvec3 other = glm::cross(pole, shaped.axis);
        for (const double share : {0.0, 0.5, 1.0, -0.5})
            sweepOurs(subject, shaped.joint,
                      glm::normalize((1.0 - std::abs(share)) * shaped.axis + share * other),
                      result);
    }
    return result;
}

} // namespace quality
