// SPDX-License-Identifier: MIT
#pragma once

#include "points/Four.h"

#include <osgSkin/GlmTypes>
#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

namespace osgSkin {

/// What bounds need of a joint in a pose.
struct JointMotion {
    glm::dquat turn; ///< G: x -> move + scale * turn x
    glm::dvec3 move;
    double scale;
    FourMap map;                         ///< the same
    Four bendAxis, twistAxis, crossAxis; ///< v, w and v x w
    float bend;                          ///< psi
    float twist;                         ///< phi
    Four centre, translation;            ///< of the joint; the root's translation is in its map
    float scaled;                        ///< its own scale less 1
    float travel;                        ///< by how much it is translated; of the root 0
    float scaling;                       ///< its own scale's difference from 1
    float growth;                        ///< its own scale, at least 1
    float growthHere; ///< the product of the growths of this joint and those above it
};

/// The same of all joints.
struct JointMotions {
    /// \param room for as many as the pose has joints
    JointMotions(const SkinModel& model, const Pose& pose, JointMotion* room) noexcept;

    const JointMotion* joints;
    bool plain = true; ///< but for the root none is moved or scaled, nor is that scaled
};

} // namespace osgSkin
