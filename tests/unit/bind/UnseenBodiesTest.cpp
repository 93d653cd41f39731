// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bodies of other proportions than the available ones, derived from them.
#include "KnownBody.h"
#include "Ratios.h"
#include "Stretches.h"
#include "mesh/WeldedMesh.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

/// Moves the skin in along its normals.
KnownBody thinned(KnownBody body, double distance) {
    const WeldedMesh skin(body.mesh);
    for (std::size_t v = 0; v < body.mesh.positions.size(); ++v)
        body.mesh.positions[v] -= distance * skin.normals[skin.weldedOf[v]];
    return body;
}

/// Both forearms `factor` times as long; everything beyond an elbow moves along.
KnownBody withForearms(const KnownBody& body, double factor) {
    KnownBody result = body;
    for (const std::string side : {"Left", "Right"}) {
        const auto centre = [&](const char* joint) {
            const int found = body.truth.find(side + joint);
            return body.truth.joints[static_cast<std::size_t>(found)].centre;
        };
        const glm::dvec3 elbow = centre("ForeArm");
        const glm::dvec3 bone = centre("Hand") - elbow;
        const auto moved = [&](const glm::dvec3& p) {
            if ((p.x > 0.0) != (elbow.x > 0.0) || std::abs(p.x) < std::abs(elbow.x) - 0.5) return p;
            const double along = glm::dot(p - elbow, bone) / glm::dot(bone, bone);
            return p + (factor - 1.0) * std::clamp(along, 0.0, 1.0) * bone;
        };
        result = result.mapped(moved);
    }
    return result;
}

/// l'/l of the body's edges with both arms raised.
std::vector<double> stretchesWithArmsUp(const KnownBody& body) {
    const glm::dvec3 z(0, 0, 1);
    const KnownBody up = body.posed({{"LeftArm", glm::angleAxis(glm::radians(100.0), z)},
                                     {"RightArm", glm::angleAxis(glm::radians(-100.0), z)}});
    return stretches(body.mesh, up.mesh);
}

/// Mean ratio of the left upper arm over its middle third.
double upperArmRigidity(const KnownBody& body) {
    const Binding binding = bind(body.mesh, body.truth);
    const std::size_t arm = jointCalled(binding, "LeftArm");
    const glm::dvec3 from = binding.joints[arm].centre;
    const glm::dvec3 way = binding.joints[jointCalled(binding, "LeftForeArm")].centre - from;
    double sum = 0.0, count = 0.0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        if (binding.regions[v] != arm) continue;
        const double along = glm::dot(body.mesh.positions[v] - from, way) / glm::dot(way, way);
        if (along < 1.0 / 3.0 || along > 2.0 / 3.0) continue;
        sum += static_cast<double>(ratiosOf(binding, v, arm).bend);
        count += 1.0;
    }
    return sum / count;
}

} // namespace

TEST(UnseenBodies, ThinArmpitsStretchLittle) {
    const KnownBody neutral = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (neutral.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    for (const double millimetres : {0.0, 6.0, 8.0})
        EXPECT_LT(stretchesWithArmsUp(thinned(neutral, 0.01 * millimetres)).back(), 2.45)
            << millimetres << " mm thinner";
}

TEST(UnseenBodies, ThrowersArmpitsStretchLittle) {
    const std::vector<double> sorted = stretchesWithArmsUp(KnownBody::thrower());
    EXPECT_LT(sorted.back(), 2.15);
    EXPECT_LT(percentile999(sorted), 1.93);
}

TEST(UnseenBodies, LongForearmsLeaveUpperArmsRigid) {
    for (const double factor : {1.0, 1.3, 1.6})
        EXPECT_GT(upperArmRigidity(withForearms(KnownBody::thrower(), factor)), 0.965) << factor;
}

TEST(UnseenBodies, ArmsThatReachForwardsStretchLittle) {
    const KnownBody neutral = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (neutral.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    const glm::dvec3 forwards = glm::normalize(glm::dvec3(-0.8, 0.3, 0.6));
    const KnownBody posed = neutral.posed(
        {{"LeftArm", glm::angleAxis(glm::radians(80.0), forwards)},
         {"RightArm",
          glm::angleAxis(glm::radians(80.0), glm::dvec3(forwards.x, -forwards.y, -forwards.z))}});
    const std::vector<double> sorted = stretches(neutral.mesh, posed.mesh);
    EXPECT_LT(percentile999(sorted), 1.52); // 1.55 without swings
}

/// A pad over the shoulder that is attached to nothing keeps its field.
TEST(UnseenBodies, PadsOnTheShoulderStayOnIt) {
    KnownBody body = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (body.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    const glm::dvec3 shoulder =
        body.truth.joints.at(std::size_t(body.truth.find("LeftArm"))).centre;
    const std::vector<glm::dvec3> skin = body.mesh.positions;
    const double height = glm::distance(shoulder, body.truth.joints.front().centre) * 3.0;
    // The pad vertex of each skin vertex, moved away from the joint by a hundredth of the height.
    std::vector<std::uint32_t> padOf(skin.size(), 0), below;
    const std::vector<std::uint32_t> corners = body.mesh.triangles();
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        const auto isNear = [&](std::uint32_t v) {
            return glm::distance(skin[v], shoulder) < 0.045 * height;
        };
        if (!std::all_of(corners.begin() + std::ptrdiff_t(t),
                         corners.begin() + std::ptrdiff_t(t + 3), isNear))
            continue;
        for (std::size_t c = t; c < t + 3; ++c) {
            const std::uint32_t v = corners[c];
            if (padOf[v] == 0) {
                padOf[v] = static_cast<std::uint32_t>(body.mesh.positions.size());
                below.push_back(v);
                body.mesh.positions.push_back(skin[v] +
                                              0.01 * height * glm::normalize(skin[v] - shoulder));
            }
            body.mesh.faceVertices.push_back(padOf[v]);
        }
        body.mesh.faceSizes.push_back(3);
    }
    ASSERT_GT(below.size(), 30u);
    const glm::dvec3 forwards = glm::normalize(glm::dvec3(-0.8, 0.3, 0.6));
    const KnownBody posed = body.posed({{"LeftArm", glm::angleAxis(glm::radians(80.0), forwards)}});
    double farthest = 0.0;
    for (std::size_t i = 0; i < below.size(); ++i)
        farthest = std::max(farthest, glm::distance(posed.mesh.positions[skin.size() + i],
                                                    posed.mesh.positions[below[i]]));
    EXPECT_LT(farthest, 0.02 * height); // 0.03 if it is stretched
}
