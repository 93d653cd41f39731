// SPDX-License-Identifier: GPL-3.0-or-later
#include "ClipBounds.h"

#include <osgSkin/GlmOsg>

#include <osg/BoundingBox>

#include <algorithm>

namespace osgSkin {
namespace {

/// Joint centres at one sample, in skeleton space (forward kinematics of the clip).
std::vector<glm::dvec3> jointCentres(const Clip& clip, const RestSkeleton& rig, std::size_t frame) {
    std::vector<glm::dvec3> centres(rig.joints.size());
    std::vector<glm::dquat> turns(rig.joints.size());
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const RestJoint& joint = rig.joints[j];
        const glm::dquat& local = clip.rotations[frame * clip.joints + j];
        if (joint.parent < 0) {
            centres[j] = clip.rootPositions[frame];
            turns[j] = local;
            continue;
        }
        const auto parent = static_cast<std::size_t>(joint.parent);
        centres[j] = centres[parent] + turns[parent] * (joint.centre - rig.joints[parent].centre);
        turns[j] = turns[parent] * local;
    }
    return centres;
}

/// The largest distance from a vertex to the centre of its region's joint.
double skinDistance(const Binding& binding, const SkinMesh& mesh) {
    double distance = 0.0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        distance = std::max(
            distance, glm::length(mesh.positions[v] - binding.joints[binding.regions[v]].centre));
    return distance;
}

} // namespace

osg::BoundingSphere clipBounds(const Clip& clip, const RestSkeleton& rig, const Binding& binding,
                               const SkinMesh& mesh, const osg::Matrix& toWorld) {
    // A character stays within a hand's breadth of where it is a few samples earlier.
    const std::size_t step = std::max<std::size_t>(1, clip.frames / 200);
    std::vector<osg::Vec3d> points;
    osg::BoundingBoxd box;
    for (std::size_t frame = 0; frame < clip.frames; frame += step)
        for (const glm::dvec3& centre : jointCentres(clip, rig, frame)) {
            points.push_back(toOsg(centre) * toWorld);
            box.expandBy(points.back());
        }
    double radius = 0.0;
    for (const osg::Vec3d& point : points)
        radius = std::max(radius, (point - box.center()).length());
    return {box.center(), static_cast<float>(radius + skinDistance(binding, mesh))};
}

} // namespace osgSkin
