// SPDX-License-Identifier: MIT
#include "clips/BoundWay.h"

#include <glm/common.hpp>

#include <cmath>

namespace osgSkin {
namespace {

constexpr std::size_t kWayParts = BakedClip::kParts;
constexpr double kHalfTurn = 2.9;     ///< radians, nearly
constexpr double kTwistJump = 1.0;    ///< of a twist, radians in a step
constexpr float kWayMargin = 0.25f;   ///< of a second difference: twice an eighth
constexpr float kWayRounding = 1e-5f; ///< of a coordinate

using Moments = std::array<SkinMoment, kWayParts + 1>;

/// Whether splits change little by little all the way, but for the root's: nothing follows that in
/// part.
bool isSmooth(const Moments& moments) {
    for (std::size_t j = 1; j < moments.front().pose.size(); ++j) {
        double before = moments.front().pose.transform(j).split.twistAngle;
        for (const SkinMoment& moment : moments) {
            const BendTwist split = moment.pose.transform(j).split;
            if (split.bendAngle > kHalfTurn || std::abs(split.twistAngle) > kHalfTurn ||
                std::abs(split.twistAngle - before) > kTwistJump)
                return false;
            before = split.twistAngle;
        }
    }
    return true;
}

/// How far a vertex may be from the lines between its places.
glm::vec3 marginOf(const Moments& moments, std::size_t vertex) {
    glm::vec3 most(0.0f);
    for (std::size_t k = 1; k < kWayParts; ++k)
        most = glm::max(most, glm::abs(moments[k - 1].positions[vertex] -
                                       2.0f * moments[k].positions[vertex] +
                                       moments[k + 1].positions[vertex]));
    return kWayMargin * most + kWayRounding * glm::abs(moments[0].positions[vertex]);
}

} // namespace

void boundWay(const Moments& moments, std::vector<osg::BoundingBox>& boxes) {
    std::array<osg::BoundingBox, kWayParts> ways;
    const std::size_t vertices =
        isSmooth(moments) ? moments.front().positions.size() : std::size_t{0};
    for (std::size_t v = 0; v < vertices; ++v) {
        const glm::vec3 margin = marginOf(moments, v);
        for (std::size_t k = 0; k < kWayParts; ++k)
            for (const std::size_t end : {k, k + 1}) {
                const glm::vec3& p = moments[end].positions[v];
                const glm::vec3 low = p - margin, high = p + margin;
                ways[k].expandBy(low.x, low.y, low.z);
                ways[k].expandBy(high.x, high.y, high.z);
            }
    }
    boxes.insert(boxes.end(), ways.begin(), ways.end());
}

} // namespace osgSkin
