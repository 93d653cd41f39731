// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/DrivenRig.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// Carries the root motion over to a rig of another size, and puts the feet on the floor.
///
/// The root motion is that of the first rig joint that the motion drives (the hips), relative to
/// where it is in the motion's zero pose and scaled by the ratio of hip heights. Heights are then
/// shifted by one number for the whole clip, so that the feet's lowest position is the floor that
/// the rig stands on at rest. A jump stays a jump: the shift is taken from the frames in which the
/// feet are lowest. A motion that begins far from the origin begins where the rig rests.
class RootMotion {
public:
    /// \param body the rig and its motion; it must outlive this
    explicit RootMotion(const DrivenRig& body);

    double scale() const { return _scale; }

    /// Adds a sample: the position of the motion's root, and the world orientations of both.
    void add(const glm::dvec3& motionRoot, const std::vector<glm::dquat>& motionWorld,
             const std::vector<glm::dquat>& rigWorld);

    /// Where the joints are in the sample added last; the rig's before finish() puts it on its
    /// floor.
    const std::vector<glm::dvec3>& motionPositions() const { return _motionPositions; }
    const std::vector<glm::dvec3>& rigPositions() const { return _rigPositions; }

    /// What is added to the scaled root motion, after finish(): hips = scale * motion's hips +
    /// offset.
    const glm::dvec3& offset() const { return _offset; }

    /// The position of the rig's root in each sample.
    std::vector<glm::dvec3> finish();

    /// Whether finish() moved the motion to the origin.
    bool movedToOrigin() const { return _movedToOrigin; }

private:
    void startAtOrigin();
    double lowestFoot(const std::vector<glm::dquat>& rigWorld) const;

    const DrivenRig& _body;
    int _rigHips = 0;
    int _motionHips = 0;
    double _rigHeight = 0.0; ///< of the hips
    double _scale = 1.0;
    glm::dvec3 _offset{0.0};
    glm::dvec3 _start{0.0}; ///< of the hips in the first sample, from where they are at rest
    bool _movedToOrigin = false;
    std::vector<glm::dvec3> _roots;
    std::vector<double> _feet; ///< height of the lowest foot above its rest height, [sample]
    std::vector<glm::dvec3> _motionPositions, _rigPositions;
};

} // namespace osgSkin
