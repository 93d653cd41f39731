// SPDX-License-Identifier: MIT
#include <osgSkin/PoseBounds>

#include "bounds/BlendedPieces.h"
#include "bounds/CorrectiveStray.h"
#include "bounds/JointMotions.h"
#include "bounds/PosedPieces.h"
#include "model/SkinModelAccess.h"

#include <osgSkin/GlmTypes>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace osgSkin {
namespace {

/// A side of the box where it is a number, else as far out as poses may reach.
float bounded(float side, float otherwise) {
    return std::abs(side) <= static_cast<float>(kLargestCoordinate) ? side : otherwise; // NaN too
}

} // namespace

PoseBounds computePoseBounds(const SkinModel& model, const Pose& pose) noexcept {
    const BoundsProxy* proxy = SkinModelAccess::boundsProxy(model);
    if (!proxy) return {glm::vec3(1.0f), glm::vec3(-1.0f)};
    std::array<JointMotion, 128> few;
    std::vector<JointMotion> many(pose.size() > few.size() ? pose.size() : 0);
    JointMotions motions(*proxy, pose, many.empty() ? few.data() : many.data());
    std::optional<CorrectiveStray> corrections;
    if (SkinModelAccess::correctives(model)) corrections.emplace(*proxy, model, pose);
    PosedPieces pieces(*proxy, motions, corrections ? &*corrections : nullptr);
    FourBox box{all(std::numeric_limits<float>::max()), all(-std::numeric_limits<float>::max())};
    if (motions.isPlain())
        BlendedPieces(*proxy, motions).addTo(pieces, box);
    else
        for (const BoundsProxy::Piece& piece : proxy->pieces) pieces.add(piece, box);
    PoseBounds bounds{box.low.xyz(), box.high.xyz()};
    for (int axis = 0; axis < 3; ++axis) {
        bounds.low[axis] = bounded(bounds.low[axis], -static_cast<float>(kLargestCoordinate));
        bounds.high[axis] = bounded(bounds.high[axis], static_cast<float>(kLargestCoordinate));
    }
    return bounds;
}

} // namespace osgSkin
