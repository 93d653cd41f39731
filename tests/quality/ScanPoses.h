// SPDX-License-Identifier: MIT
#pragma once

#include "CapturedPeople.h"

#include <osgSkinRig/RestSkeleton>

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <vector>

namespace quality {

/// Where the rigid parts of a person's body are in each scan: the middles of limbs, hands, feet,
/// head, chest and pelvis say how the joints between them rotate.
///
/// The bodies' joints have CMU's names (osgSkin::fittedJointNames()); missing ones are allowed.
class RigidParts {
public:
    /// \param person must outlive this object
    /// \param rig joints of the person at rest
    /// \param regions of the vertices at rest: joints of the rig
    RigidParts(const CapturedPerson& person, const osgSkin::RestSkeleton& rig,
               const std::vector<std::uint32_t>& regions);

    /// Moves the joints of arms and legs to where the parts on both sides rotate about them in all
    /// scans, by the same least squares, with a preference for where they are.
    osgSkin::RestSkeleton turnedJoints() const;

    struct Pose {
        std::vector<glm::dmat4> skinning; ///< G_j of each joint
        double scale = 1.0;               ///< of the scan, relative to the person at rest
    };
    /// The pose of a scan by least squares over the parts' corresponding points and distances from
    /// the scan. Spine and neck bend evenly; joints without a part below them, such as fingers,
    /// stay.
    /// \param rig of turnedJoints(), or the one at rest
    Pose solve(const osgSkin::RestSkeleton& rig, const Scan& scan) const;

    struct Target;

private:
    struct Solved;
    struct Part {
        std::size_t joint;
        std::vector<std::uint32_t> vertices; ///< at rest
    };
    const Part* partOf(int joint) const;
    Solved solvedPose(const osgSkin::RestSkeleton& rig, const Scan& scan) const;

    const CapturedPerson& _person;
    osgSkin::RestSkeleton _rig;
    std::vector<Part> _parts;
};

} // namespace quality
