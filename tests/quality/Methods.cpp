// SPDX-License-Identifier: MIT
#include "Methods.h"

#include <DualQuaternionBlend.h>
#include <LinearBlend.h>
#include <osgSkin/DeformJob>

#include <glm/gtc/matrix_transform.hpp>

#include <stdexcept>

namespace quality {
namespace {

PosedSkin deformOurs(const Subject& subject, const std::vector<glm::dmat4>& skinning,
                     bool withNormals) {
    osgSkin::Pose pose(subject.binding.joints);
    if (!pose.set(skinning.data(), skinning.size()))
        throw std::runtime_error("a pose cannot be set: expected finite matrices, one a joint");
    std::vector<glm::vec3> posed(subject.rest.size()), normals(withNormals ? posed.size() : 0);
    osgSkin::DeformJob job;
    job.model = subject.model.get();
    job.pose = &pose;
    job.positions = posed.data();
    job.positionCount = posed.size();
    job.normals = withNormals ? normals.data() : nullptr;
    job.normalCount = normals.size();
    job.validate();
    job.run();
    return {{posed.begin(), posed.end()}, {normals.begin(), normals.end()}};
}

/// Points moved and normals turned by a matrix for each vertex.
PosedSkin deformBy(const std::vector<glm::dmat4>& matrices, const Subject& subject) {
    PosedSkin posed{compare::transformPoints(matrices, subject.rest), {}};
    for (std::size_t v = 0; v < matrices.size(); ++v) {
        const glm::dvec3 turned = glm::dmat3(matrices[v]) * subject.normals[v];
        const double length = glm::length(turned);
        posed.normals.push_back(length > 0.0 ? turned / length : turned);
    }
    return posed;
}

} // namespace

const char* nameOf(Method method) {
    constexpr std::array<const char*, 3> kNames{"LBS", "DQS", "ours"};
    return kNames[static_cast<std::size_t>(method)];
}

compare::Points deform(const Subject& subject, Method method,
                       const std::vector<glm::dmat4>& skinning) {
    switch (method) {
    case Method::Linear:
        return compare::linearBlend(subject.rest, subject.weights, skinning);
    case Method::DualQuaternion:
        return compare::dualQuaternionBlend(subject.rest, subject.weights, skinning);
    case Method::Ours:
        break;
    }
    return deformOurs(subject, skinning, false).points;
}

PosedSkin deformWithNormals(const Subject& subject, Method method,
                            const std::vector<glm::dmat4>& skinning) {
    switch (method) {
    case Method::Linear:
        return deformBy(compare::linearBlendMatrices(subject.weights, skinning), subject);
    case Method::DualQuaternion:
        return deformBy(compare::dualQuaternionBlendMatrices(subject.weights, skinning), subject);
    case Method::Ours:
        break;
    }
    return deformOurs(subject, skinning, true);
}

std::vector<glm::dmat4> singleTurn(const Subject& subject, std::size_t joint,
                                   const glm::dvec3& axis, double angle) {
    const glm::dmat4 unit(1.0);
    const glm::dvec3& centre = subject.binding.joints[joint].centre;
    const glm::dmat4 turn = glm::translate(unit, centre) * glm::rotate(unit, angle, axis) *
                            glm::translate(unit, -centre);
    std::vector<glm::dmat4> skinning(subject.rig.joints.size(), unit);
    for (std::size_t j = joint; j < skinning.size(); ++j)
        if (subject.rig.isInSubtree(static_cast<int>(j), static_cast<int>(joint)))
            skinning[j] = turn;
    return skinning;
}

} // namespace quality
