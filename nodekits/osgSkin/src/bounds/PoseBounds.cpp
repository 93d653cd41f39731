// SPDX-License-Identifier: MIT
#include <osgSkin/PoseBounds>

#include "bounds/BoundsKernel.h"
#include "model/BoundsProxy.h"
#include "model/SkinBlocks.h"
#include "pose/CorrectiveWeights.h"

#include <osgSkin/GlmTypes>
#include <osgSkin/Pose>

#include <array>
#include <cmath>
#include <vector>

namespace osgSkin {

namespace {

/// The absolute weights of corrective modes in a pose; times BoundsProxy::Reach, they bound how far
/// correctives move vertices.
class CorrectiveDisplacementBound {
public:
    /// \pre the model has correctives
    CorrectiveDisplacementBound(const SkinModel& model, const Pose& pose) noexcept {
        CorrectiveWeights weights(model, pose);
        const std::size_t joints = SkinModelAccess::correctives(model)->joints.size();
        for (std::uint32_t joint = 0; joint < joints; ++joint) {
            const CorrectiveWeights::Weights* now = weights.of(joint);
            float* const to = &_weights[BoundsProxy::weightOf(joint, 0)];
            for (std::size_t k = 0; k < weights.modesOf(joint); ++k)
                to[k] = now ? std::abs(now->positions[k]) : 0.0f;
        }
    }

    /// By BoundsProxy::weightOf().
    const float* weights() const { return _weights.data(); }

private:
    std::array<float, BoundsProxy::kMaxWeights> _weights;
};

/// A side of the box, limited to the range of poses.
float bounded(float side, float otherwise) {
    return std::abs(side) <= static_cast<float>(kLargestCoordinate) ? side : otherwise; // NaN too
}

Box4 boxOfCorrected(const BoundsProxy& proxy, const SkinModel& model, const Pose& pose,
                    JointMotion* room) {
    const CorrectiveDisplacementBound corrections(model, pose);
    return boxOf(proxy, pose, room, corrections.weights());
}

} // namespace

PoseBounds computePoseBounds(const SkinModel& model, const Pose& pose) noexcept {
    const BoundsProxy* proxy = SkinModelAccess::boundsProxy(model);
    if (!proxy) return {glm::vec3(1.0f), glm::vec3(-1.0f)};
    std::array<JointMotion, 128> few;
    std::vector<JointMotion> many(pose.size() > few.size() ? pose.size() : 0);
    JointMotion* room = many.empty() ? few.data() : many.data();
    const Box4 box = SkinModelAccess::correctives(model) ? boxOfCorrected(*proxy, model, pose, room)
                                                         : boxOf(*proxy, pose, room, nullptr);
    PoseBounds bounds{box.low.xyz(), box.high.xyz()};
    for (int axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = bounded(bounds.low[axis], -static_cast<float>(kLargestCoordinate));
        bounds.high[axis] = bounded(bounds.high[axis], static_cast<float>(kLargestCoordinate));
    }
    return bounds;
}

} // namespace osgSkin
