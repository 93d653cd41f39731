// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/BodyParts.h"
#include "skeleton/SkeletonTree.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// Carries the root's way over to a rig of another size, and puts the feet on the floor.
///
/// The way is that of the first rig joint that the motion drives (the hips), relative to its place
/// in the motion's zero pose and scaled by the ratio of hip heights. Heights are then shifted by
/// one number for the whole clip, so that the feet's lowest place is the floor that the rig stands
/// on at rest. A jump stays a jump: the shift is taken from the frames in which the feet are
/// lowest.
class RootMotion {
public:
    RootMotion(const SkeletonTree& rig, const SkeletonTree& motion,
               const std::vector<int>& motionJoint);

    double scale() const { return _scale; }

    /// Adds a sample: the motion root's place, and the world orientations of both.
    void add(const glm::dvec3& motionRoot, const std::vector<glm::dquat>& motionWorld,
             const std::vector<glm::dquat>& rigWorld);

    /// Where the joints are in the sample added last; the rig's before finish() puts it on its
    /// floor.
    const std::vector<glm::dvec3>& motionPlaces() const { return _motionPlaces; }
    const std::vector<glm::dvec3>& rigPlaces() const { return _rigPlaces; }

    /// What is added to the scaled way, after finish(): hips = scale * motion's hips + offset.
    const glm::dvec3& offset() const { return _offset; }

    /// The rig root's place in each sample.
    std::vector<glm::dvec3> finish();

private:
    double lowestFoot(const std::vector<glm::dquat>& rigWorld) const;

    const SkeletonTree& _rig;
    const SkeletonTree& _motion;
    int _rigHips = 0;
    int _motionHips = 0;
    double _rigHeight = 0.0; ///< of the hips
    double _scale = 1.0;
    glm::dvec3 _offset{0.0};
    BodyParts _rigParts;
    std::vector<glm::dvec3> _roots;
    std::vector<double> _feet; ///< height of the lowest foot above its rest height, [sample]
    std::vector<glm::dvec3> _motionPlaces, _rigPlaces;
};

} // namespace osgSkin
