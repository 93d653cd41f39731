// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/GlmOsg>
#include <osgSkin/Pose>
#include <osgSkinMotion/SampledClip>
#include <osgSkinRig/RestSkeleton>

#include <glm/gtc/quaternion.hpp>

#include <osg/Matrixd>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// A sample as a map of rest space, relative to the joint's parent.
inline JointMap mapOf(const JointSample& joint, const glm::dvec3& centre) {
    return {joint.rotation, centre + joint.translation - joint.scale * (joint.rotation * centre),
            joint.scale};
}

/// First `b`, then `a`.
inline JointMap operator*(const JointMap& a, const JointMap& b) {
    return {a.rotation * b.rotation, a.offset + a.scale * (a.rotation * b.offset),
            a.scale * b.scale};
}

inline JointMap inverse(const JointMap& a) {
    const glm::dquat back = glm::conjugate(a.rotation);
    return {back, -(back * a.offset) / a.scale, 1.0 / a.scale};
}

inline glm::dvec3 apply(const JointMap& map, const glm::dvec3& point) {
    return map.offset + map.scale * (map.rotation * point);
}

inline osg::Matrixd toMatrix(const JointMap& map) {
    osg::Matrixd result = osg::Matrixd::rotate(toOsg(map.rotation));
    if (map.scale != 1.0) result = osg::Matrixd::scale(map.scale, map.scale, map.scale) * result;
    result.setTrans(toOsg(map.offset));
    return result;
}

/// The rest pose of a clip's joints.
inline RestSkeleton restOf(const SampledClip& clip) {
    RestSkeleton rest;
    for (const SampledClip::Joint& joint : clip.joints())
        rest.add(joint.name, joint.parent, joint.centre);
    return rest;
}

/// The joints' maps including those above them, in rest space.
/// \param joints one for each sample, parents first
/// \param whole resized to one for each joint
inline void localToModel(const std::vector<SampledClip::Joint>& joints, const JointSample* samples,
                         std::vector<JointMap>& whole) {
    whole.resize(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const JointMap own = mapOf(samples[j], joints[j].centre);
        whole[j] =
            joints[j].parent < 0 ? own : whole[static_cast<std::size_t>(joints[j].parent)] * own;
    }
}

} // namespace osgSkin
