// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/JointRoles>

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Finds out where a body lies whose actor stands: then the joints do not match, or what is up.
class StandingCheck {
public:
    /// \param rig what the rig's joints are
    /// \param motion what the motion's joints are
    StandingCheck(const JointRoles& rig, const JointRoles& motion) : _rig(rig), _motion(motion) {}

    /// Adds a sample.
    /// \param rig where the rig's joints are, +y up
    /// \param motion where the motion's joints are, +y up
    void add(const std::vector<glm::dvec3>& rig, const std::vector<glm::dvec3>& motion);

    /// \throw osgSkin::Error where the rig's hips are as low as its feet in most of the samples in
    ///        which the actor's feet are under his
    void finish() const;

private:
    /// A body's legs; those that are not there are -1.
    struct Legs {
        explicit Legs(const JointRoles& roles);
        bool complete() const;
        /// How high the hips are above the feet, in leg lengths.
        double height(const std::vector<glm::dvec3>& positions) const;
        int upper[2], lower[2], foot[2];
    };
    Legs _rig, _motion;
    std::size_t _standing = 0, _lying = 0;
};

} // namespace osgSkin
