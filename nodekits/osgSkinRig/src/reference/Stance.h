// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/JointRoles>

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace osgSkin {

/// How a body holds itself in one pose, whichever way the pose's axes lie.
struct Stance {
    glm::dvec3 up{0.0};     ///< unit, from the feet to the hips along the legs
    glm::dvec3 hips{0.0};   ///< where they are
    double leg = 0.0;       ///< length, hip to ankle along the bones
    double lowest = 0.0;    ///< along `up`: the lower ankle
    double knees = 0.0;     ///< degrees that the more bent knee is off straight
    double spread = 0.0;    ///< degrees between a leg and the middle of both
    double lean = 0.0;      ///< degrees between trunk and legs
    double tilt = 0.0;      ///< degrees that the hips are off level
    double elbows = 0.0;    ///< degrees that the more bent elbow is off straight; 0 without arms
    double asymmetry = 0.0; ///< degrees by which the arms hang differently; 0 without arms

    /// Whether this is somebody who stands: on straight legs, the trunk over them.
    bool stands() const;

    /// How far from the pose of a calibration, in which arms are straight and alike; 0 is that.
    double untidiness() const;
};

/// The joints by which a body's stance is told.
class StanceJoints {
public:
    /// \param roles of a skeleton's joints
    explicit StanceJoints(const JointRoles& roles);

    /// Whether both legs and a trunk are there.
    bool complete() const { return _complete; }

    /// Nothing where a bone of the legs or the trunk has no length.
    /// \param positions of the skeleton's joints
    std::optional<Stance> measure(const std::vector<glm::dvec3>& positions) const;

private:
    struct Limb {
        int upper = -1, lower = -1, end = -1;
        bool complete() const { return upper >= 0 && lower >= 0 && end >= 0; }
    };
    Limb _legs[2], _arms[2];
    int _top = -1; ///< head, neck or chest
    bool _complete = false;
};

} // namespace osgSkin
