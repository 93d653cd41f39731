// SPDX-License-Identifier: MIT
#pragma once

#include "model/CorrectiveBlocks.h"
#include "model/SkinBlocks.h"

#include <osgSkin/DeformJob>
#include <osgSkin/GlmTypes>
#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <cstddef>

namespace osgSkin {

/// Whether a pose is the rest pose, with all inputs 0.
inline bool isAtRest(const SkinModel& model, const Pose& pose) noexcept {
    const glm::dvec3 none(0.0);
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const JointTransform joint = pose.transform(j);
        if (!isIdentity(joint.rotation) || joint.offset != none || joint.scale != 1.0 ||
            joint.split.bendAngle != 0.0 || joint.split.twistAngle != 0.0)
            return false;
    }
    if (const CorrectiveBlocks* correctives = SkinModelAccess::correctives(model))
        for (std::size_t i = 0; i < correctives->inputs.size(); ++i)
            if (pose.input(i) != 0.0f) return false;
    return true;
}

/// Copies rest vertices `first` to before `end` of SkinModel::order() to a valid job's outputs, so
/// that they are exact: kernels keep them in their groups' frames, where they are rounded.
inline void copyRest(const DeformJob& job, std::size_t first, std::size_t end) noexcept {
    const SkinModel& model = *job.model;
    for (std::size_t i = first; i < end; ++i) {
        const std::uint32_t v = model.order()[i];
        job.positions[v] = model.positions()[v];
        if (job.normals) job.normals[v] = model.normals()[v];
        if (job.tangents) job.tangents[v] = job.restTangents->tangents()[v];
    }
}

} // namespace osgSkin
