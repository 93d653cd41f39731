// SPDX-License-Identifier: MIT
#include <osgSkin/PoseBounds>

#include <osgSkin/DeformJob>

#include "correctives/CorrectiveStray.h"
#include "model/BoundsProxy.h"
#include "model/SkinModelAccess.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace osgSkin {
namespace {

constexpr std::uint32_t kChunk = 256; ///< patches that are worked on at a time
constexpr float kRounding = 1e-6f;    ///< of a coordinate: several roundings
using Floats = std::array<float, kChunk>;

/// How far the joints, the root aside, are translated in all.
float travelOf(const Pose& pose) {
    double travel = 0.0;
    for (std::size_t j = 1; j < pose.size(); ++j)
        travel += glm::length(pose.transform(j).translation);
    return static_cast<float>(travel);
}

/// By how much the joints that a group follows scale its vertices at most.
float scaleOf(const SkinModel& model, const SkinModel::Group& group, const Pose& pose) {
    double scale = 1.0;
    for (std::uint32_t i = group.firstLink; i < group.firstLink + group.linkCount; ++i)
        scale *= std::max(1.0, pose.transform(model.links()[i].joint).scale);
    return static_cast<float>(scale);
}

/// How far vertices may stray from each patch of a run, which has the mean ratios.
void straysOf(const BoundsProxy& skin, const BoundsProxy::Run& run, std::uint32_t from,
              std::uint32_t count, const Pose& pose, float travel, Floats& stray) {
    std::fill_n(stray.begin(), count, skin.rounding);
    for (std::uint32_t k = 0; k < run.jointCount; ++k) {
        const JointTransform turn = pose.transform(skin.joints[run.firstJoint + k]);
        // A share of the scale comes in with the bend, and takes a vertex as far as it reaches.
        const float bend = static_cast<float>(turn.split.bendAngle + std::abs(turn.scale - 1.0));
        const float twist = static_cast<float>(std::abs(turn.split.twistAngle));
        const float* slack = skin.slack.data() + run.firstSlack + from +
                             std::size_t(k) * BoundsProxy::SlackKinds * run.patchCount;
        const float* bendReach = slack + std::size_t(BoundsProxy::BendReach) * run.patchCount;
        const float* twistReach = slack + std::size_t(BoundsProxy::TwistReach) * run.patchCount;
        for (std::uint32_t i = 0; i < count; ++i)
            stray[i] += bend * bendReach[i] + twist * twistReach[i];
        if (travel <= skin.rounding) continue;
        const float* bendSpread = slack + std::size_t(BoundsProxy::BendSpread) * run.patchCount;
        const float* twistSpread = slack + std::size_t(BoundsProxy::TwistSpread) * run.patchCount;
        for (std::uint32_t i = 0; i < count; ++i)
            stray[i] += travel * ((1.0f + bend) * bendSpread[i] + twist * twistSpread[i]);
    }
}

/// Adds patches `first` to `first + count` of the posed `centres` and `normals` to `box`.
void addPatches(const BoundsProxy& skin, std::uint32_t first, std::uint32_t count,
                const glm::vec3* centres, const glm::vec3* normals, const Floats& stray,
                float scale, PoseBounds& box) {
    glm::vec3 low = box.low, high = box.high;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 centre = centres[i];
        const glm::vec3 tilt = glm::min(glm::abs(normals[i]), 1.0f);
        const glm::vec3 half = scale * (skin.across[first + i] * glm::sqrt(1.0f - tilt * tilt) +
                                        skin.along[first + i] * tilt + stray[i]) +
                               kRounding * glm::abs(centre);
        low = glm::min(low, centre - half);
        high = glm::max(high, centre + half);
    }
    box.low = low;
    box.high = high;
}

} // namespace

PoseBounds computePoseBounds(const SkinModel& model, const Pose& pose) noexcept {
    const BoundsProxy* skin = SkinModelAccess::boundsProxy(model);
    if (!skin) return {glm::vec3(1.0f), glm::vec3(-1.0f)};
    const std::size_t patches = skin->across.size();
    std::array<glm::vec3, 2 * BoundsProxy::kMost> few;
    std::vector<glm::vec3> many(patches > BoundsProxy::kMost ? 2 * patches : 0);
    DeformJob job;
    job.model = skin->centres.get();
    job.pose = &pose;
    job.positions = many.empty() ? few.data() : many.data();
    job.normals = job.positions + patches;
    job.positionCount = job.normalCount = patches;
    job.run();

    PoseBounds box{glm::vec3(std::numeric_limits<float>::max()),
                   glm::vec3(-std::numeric_limits<float>::max())};
    const float travel = travelOf(pose);
    Floats stray;
    std::optional<CorrectiveWeights> corrections;
    if (SkinModelAccess::correctives(model)) corrections.emplace(model, pose);
    for (std::size_t r = 0; r < skin->runs.size(); ++r) { // one a group
        const BoundsProxy::Run& run = skin->runs[r];
        const float scale = scaleOf(model, model.groups()[r], pose);
        for (std::uint32_t from = 0; from < run.patchCount; from += kChunk) {
            const std::uint32_t count = std::min<std::uint32_t>(run.patchCount - from, kChunk);
            const std::uint32_t first = run.firstPatch + from;
            straysOf(*skin, run, from, count, pose, travel, stray);
            if (corrections)
                addCorrectiveStray(*skin, run, from, count, *corrections, stray.data());
            addPatches(*skin, first, count, job.positions + first, job.normals + first, stray,
                       scale, box);
        }
    }
    return box;
}

} // namespace osgSkin
