// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/Alignment.h"
#include "skeleton/SkeletonTree.h"

#include <osgSkinRig/FootSkate>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// Puts on record how far the rig's feet slide where the actor's own are planted.
///
/// Both skeletons stand with +y up. Feet are told by the rig's shape: the leg joints near the floor
/// that the motion drives.
class MeasureFeet {
public:
    /// \param motionJoint for each rig joint, the motion joint that drives it, or -1
    MeasureFeet(const SkeletonTree& rig, const SkeletonTree& motion,
                const std::vector<int>& motionJoint);

    /// Where all joints of a skeleton are in a sample, and how they are turned from the zero pose.
    struct Posed {
        const std::vector<glm::dvec3>& places;
        const std::vector<glm::dquat>& world;
    };
    void add(const Posed& rig, const Posed& motion);

    /// \param scale of the root's way
    std::vector<FootSkate> finish(double frameTime, double scale) const;

private:
    struct Foot {
        int rigJoint, motionJoint;
        double rigLeg, motionLeg;
        BonePair ball;                       ///< from the ankle, at rest
        std::vector<glm::dvec3> rig, motion; ///< places, [frame]
    };

    const SkeletonTree& _rig;
    const SkeletonTree& _motion;
    std::vector<Foot> _feet;
};

} // namespace osgSkin
