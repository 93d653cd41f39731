// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/Alignment.h"
#include "retarget/DrivenRig.h"

#include <osgSkinRig/FootSkate>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// Puts on record how far the rig's feet slide where the actor's own are planted.
///
/// Feet are told by the rig's shape: the leg joints near the floor
/// that the motion drives.
class MeasureFeet {
public:
    /// \param body the rig and its motion; it must outlive this
    explicit MeasureFeet(const DrivenRig& body);

    /// Where all joints of a skeleton are in a sample, and their rotations from the zero pose.
    struct Posed {
        const std::vector<glm::dvec3>& positions;
        const std::vector<glm::dquat>& world;
    };

    /// Adds a sample.
    void add(const Posed& rig, const Posed& motion);

    /// What the samples show.
    /// \param frameTime seconds between samples
    /// \param scale of the root motion
    std::vector<FootSkate> finish(double frameTime, double scale) const;

private:
    struct Foot {
        int rigJoint, motionJoint;
        double rigLeg, motionLeg;
        BonePair ball;                       ///< from the ankle, at rest
        std::vector<glm::dvec3> rig, motion; ///< positions, [frame]
    };

    const DrivenRig& _body;
    std::vector<Foot> _feet;
};

} // namespace osgSkin
