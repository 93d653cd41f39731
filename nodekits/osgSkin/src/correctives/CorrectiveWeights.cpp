// SPDX-License-Identifier: MIT
#include "correctives/CorrectiveWeights.h"

#include "model/SkinModelAccess.h"

#include <cmath>

namespace osgSkin {

glm::dvec2 CorrectiveWeights::coordinatesOf(const CorrectiveJoint& joint) const noexcept {
    if (joint.basis == CorrectiveJoint::Basis::Input)
        return {double(_pose.input(joint.joint)), 0.0};
    const BendTwist bend = _pose.transform(joint.joint).split;
    return joint.coordinates(bend.bendAxis, bend.bendAngle, _model.joints()[joint.joint].twistAxis);
}

const CorrectiveWeights::Weights* CorrectiveWeights::of(std::uint32_t joint) noexcept {
    State& state = _states[joint];
    Weights& weights = _weights[joint];
    if (state == State::Unknown) {
        const CorrectiveJoint& from = _blocks.joints[joint];
        double beta[CorrectiveJoint::kMostModes];
        from.weights(coordinatesOf(from), beta);
        state = State::Nothing;
        for (std::size_t k = 0; k < from.modes; ++k) {
            // A rest pose read from matrices is one up to rounding errors.
            if (std::abs(beta[k]) > SkinModelAccess::blocks(_model).smallMove)
                state = State::Something;
            const double unit = beta[k] / Correctives::kUnit;
            weights.positions[k] = static_cast<float>(unit);
            weights.normals[k] =
                static_cast<float>(_blocks.hasNormals ? unit * from.normalScales[k] : 0.0);
        }
    }
    return state == State::Something ? &weights : nullptr;
}

} // namespace osgSkin
