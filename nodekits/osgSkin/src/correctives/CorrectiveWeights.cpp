// SPDX-License-Identifier: MIT
#include "correctives/CorrectiveWeights.h"

#include "correctives/WeightTerms.h"
#include "model/SkinModelAccess.h"
#include "pose/PoseAccess.h"

#include <cmath>

namespace osgSkin {

glm::dvec2 CorrectiveWeights::coordinatesOf(std::uint32_t joint) const noexcept {
    const CorrectiveJoint& of = _blocks->joints[joint];
    if (of.basis == CorrectiveJoint::Basis::Input) return {double(_pose.input(of.joint)), 0.0};
    const PoseAccess::Split split = PoseAccess::split(_pose, of.joint);
    const glm::dvec2 axis(split.azimuthCosine, split.azimuthSine);
    return std::sin(0.5 * split.bendAngle) * PoseAccess::kAzimuthStep *
           (_blocks->tables[joint].toAxes * axis);
}

void CorrectiveWeights::workOut(std::uint32_t joint) noexcept {
    const CorrectiveJoint& from = _blocks->joints[joint];
    static_assert(CorrectiveJoint::kMostModes % CorrectiveTable::kAtOnce == 0);
    double beta[CorrectiveJoint::kMostModes];
    WeightTerms(from, _blocks->tables[joint], coordinatesOf(joint)).sum(beta);
    const double small = SkinModelAccess::blocks(_model).smallMove;
    Weights& weights = _weights[joint];
    bool isSomething = false;
    for (std::size_t k = 0; k < from.modes; ++k) {
        // A rest pose read from matrices is one up to rounding errors.
        isSomething |= std::abs(beta[k]) > small;
        const double unit = beta[k] / Correctives::kUnit;
        weights.positions[k] = static_cast<float>(unit);
        weights.normals[k] =
            static_cast<float>(_blocks->hasNormals ? unit * from.normalScales[k] : 0.0);
    }
    _states[joint] = State::Known;
    _known[joint] = isSomething ? &weights : nullptr;
}

} // namespace osgSkin
