// SPDX-License-Identifier: MIT
#include <osgSkin/PoseBounds>

#include "bounds/BoundsKernel.h"
#include "bounds/CorrectiveStray.h"
#include "model/SkinModelAccess.h"

#include <osgSkin/GlmTypes>

#include <array>
#include <cmath>
#include <vector>

namespace osgSkin {
namespace {

/// A side of the box where it is a number, else as far out as poses may reach.
float bounded(float side, float otherwise) {
    return std::abs(side) <= static_cast<float>(kLargestCoordinate) ? side : otherwise; // NaN too
}

FourBox boxOfCorrected(const BoundsProxy& proxy, const SkinModel& model, const Pose& pose,
                       JointMotion* room) {
    const CorrectiveStray corrections(model, pose);
    return boxOf(proxy, pose, room, corrections.weights());
}

} // namespace

PoseBounds computePoseBounds(const SkinModel& model, const Pose& pose) noexcept {
    const BoundsProxy* proxy = SkinModelAccess::boundsProxy(model);
    if (!proxy) return {glm::vec3(1.0f), glm::vec3(-1.0f)};
    std::array<JointMotion, 128> few;
    std::vector<JointMotion> many(pose.size() > few.size() ? pose.size() : 0);
    JointMotion* room = many.empty() ? few.data() : many.data();
    const FourBox box = SkinModelAccess::correctives(model)
                            ? boxOfCorrected(*proxy, model, pose, room)
                            : boxOf(*proxy, pose, room, nullptr);
    PoseBounds bounds{box.low.xyz(), box.high.xyz()};
    for (int axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = bounded(bounds.low[axis], -static_cast<float>(kLargestCoordinate));
        bounds.high[axis] = bounded(bounds.high[axis], static_cast<float>(kLargestCoordinate));
    }
    return bounds;
}

} // namespace osgSkin
