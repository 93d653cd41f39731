// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/ClipBounds.h"

#include <osgSkin/GlmOsg>
#include <osgSkinRig/ForwardKinematics>

#include <osg/BoundingBox>

#include <algorithm>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// For each joint, the largest distance of its region's skin from its centre.
std::vector<double> skinDistances(const Binding& binding, const SkinMesh& mesh) {
    std::vector<double> distances(binding.joints.size(), 0.0);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const std::uint32_t joint = binding.regions[v];
        distances[joint] = std::max(distances[joint],
                                    glm::length(mesh.positions[v] - binding.joints[joint].centre));
    }
    return distances;
}

} // namespace

osg::BoundingSphere clipBounds(const Clip& clip, const RestSkeleton& rig, const Binding& binding,
                               const SkinMesh& mesh, const osg::Matrix& toWorld) {
    // A character stays within a hand's breadth of where it is a few samples earlier.
    const std::size_t step = std::max<std::size_t>(1, clip.frames / 200);
    const std::vector<double> distances = skinDistances(binding, mesh);
    std::vector<std::pair<osg::Vec3d, double>> balls;
    osg::BoundingBoxd box;
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> centres;
    for (std::size_t frame = 0; frame < clip.frames; frame += step) {
        worldRotations(rig, &clip.rotations[frame * clip.joints], rotations);
        worldPositions(rig, rotations, clip.rootPositions[frame], centres);
        for (std::size_t j = 0; j < centres.size(); ++j) {
            const osg::Vec3d centre = toOsg(centres[j]) * toWorld;
            const osg::Vec3d reach(distances[j], distances[j], distances[j]);
            balls.emplace_back(centre, distances[j]);
            box.expandBy(centre - reach);
            box.expandBy(centre + reach);
        }
    }
    double radius = 0.0;
    for (const auto& [centre, distance] : balls)
        radius = std::max(radius, (centre - box.center()).length() + distance);
    return {box.center(), static_cast<float>(radius)};
}

} // namespace osgSkin
