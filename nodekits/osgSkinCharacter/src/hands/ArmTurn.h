// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "hands/BodyPieces.h"

#include <osgSkin/GlmTypes>

#include <vector>

namespace osgSkin {

/// Finds the least turn of one upper arm that takes its forearm and hand out of the body.
///
/// How deep each of the arm's points is in each surface, beyond what it is at rest, goes through a
/// quadratic hinge. A fixed number of damped Gauss-Newton steps (Levenberg-Marquardt) bring all of
/// these depths towards zero, the deepest first. Steps are short and go through no decisions: the
/// turn is a continuous function of the pose.
class ArmTurn {
public:
    /// \param arm must outlive this
    /// \param surfaces of the body, posed at rest now; must outlive this
    /// \param atRest the rest pose
    ArmTurn(const ArmPiece& arm, const std::vector<BodySurface>& surfaces,
            const PosedJoints& atRest);

    /// The turn about the upper arm's joint, skeleton space; exactly 1 where the arm is free.
    /// \param pose that the surfaces have, too
    glm::dquat find(const PosedJoints& pose);

private:
    /// A rotation vector beyond `turn`; zero where the arm is free.
    glm::dvec3 step(const glm::dquat& turn) const;

    const ArmPiece& _arm;
    const std::vector<BodySurface>& _surfaces;
    double _margin;
    std::vector<double> _allowed;       ///< [surface * points + point], depth that is no contact
    std::vector<glm::dvec3> _fromJoint; ///< the points before the turn, from the upper arm's joint
    glm::dvec3 _shoulder{0.0};
};

} // namespace osgSkin
