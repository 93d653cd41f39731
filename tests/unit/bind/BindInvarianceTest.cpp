// SPDX-License-Identifier: GPL-3.0-or-later
//
// A bound and posed body is the same after moving, rotating, mirroring or scaling it, and for any
// order of its joints and any number of threads.
#include "KnownBody.h"

#include <osgSkin/Binding>
#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#ifdef OSGSKIN_HAS_TBB
#include <tbb/task_arena.h>
#endif

using namespace osgSkin;

namespace {

using Turns = std::map<std::string, glm::dquat>;

const Turns kTurns = {{"Hips", glm::angleAxis(0.4, glm::normalize(glm::dvec3(1, 2, 0)))},
                      {"Spine1", glm::angleAxis(0.3, glm::dvec3(0, 1, 0))},
                      {"LeftArm", glm::angleAxis(0.9, glm::normalize(glm::dvec3(0, 1, 2)))},
                      {"LeftForeArm", glm::angleAxis(1.6, glm::normalize(glm::dvec3(1, 1, 0)))},
                      {"LeftHand", glm::angleAxis(1.2, glm::dvec3(1, 0, 0))},
                      {"RightUpLeg", glm::angleAxis(-1.1, glm::dvec3(1, 0, 0))},
                      {"RightLeg", glm::angleAxis(1.4, glm::dvec3(1, 0, 0))}};

double heightOf(const KnownBody& body) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const glm::dvec3& p : body.mesh.positions) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    return high - low;
}

/// A map of space: x -> offset + scale * axes x, with orthogonal axes, possibly mirrored.
struct Similarity {
    const char* name;
    glm::dmat3 axes;
    double scale;
    glm::dvec3 offset;
    double tolerance; ///< in heights of the body

    glm::dvec3 operator()(const glm::dvec3& p) const { return offset + scale * (axes * p); }
    glm::dquat operator()(const glm::dquat& q) const {
        // A mirror reverses the rotation about the mirrored axis.
        const glm::dvec3 axis = glm::determinant(axes) * (axes * glm::dvec3(q.x, q.y, q.z));
        return {q.w, axis};
    }
};

double worstDistance(const KnownBody& a, const KnownBody& b) {
    double worst = 0.0;
    for (std::size_t v = 0; v < a.mesh.positions.size(); ++v)
        worst = std::max(worst, glm::distance(a.mesh.positions[v], b.mesh.positions[v]));
    return worst;
}

/// The same skeleton with each joint's children in reverse order.
osgSkin::RestSkeleton reordered(const osgSkin::RestSkeleton& skeleton) {
    std::vector<std::size_t> order, open{0};
    while (!open.empty()) {
        const std::size_t joint = open.back();
        open.pop_back();
        order.push_back(joint);
        for (std::size_t child = 0; child < skeleton.joints.size(); ++child)
            if (skeleton.joints[child].parent == static_cast<int>(joint)) open.push_back(child);
    }
    osgSkin::RestSkeleton result;
    for (const std::size_t joint : order) {
        result.joints.push_back(skeleton.joints[joint]);
        const auto parent = std::find(order.begin(), order.end(),
                                      static_cast<std::size_t>(skeleton.joints[joint].parent));
        if (skeleton.joints[joint].parent >= 0)
            result.joints.back().parent = static_cast<int>(parent - order.begin());
    }
    return result;
}

} // namespace

TEST(BindInvariance, PoseDoesNotDependOnPlacementScaleOrMirroring) {
    const glm::dmat3 none(1.0);
    const glm::dmat3 turned =
        glm::mat3_cast(glm::angleAxis(2.3, glm::normalize(glm::dvec3(1, -2, 0.5))));
    glm::dmat3 mirrored(1.0);
    mirrored[0][0] = -1.0;
    // Far from the origin a float's steps are 1/128.
    const Similarity cases[] = {{"turned", turned, 1.0, {}, 1e-5},
                                {"mirrored", mirrored, 1.0, {}, 1e-5},
                                {"small", none, 1e-4, {}, 1e-5},
                                {"large", none, 1e4, {}, 1e-5},
                                {"far", none, 100.0, {1e5, -1e5, 1e5}, 3e-4}};
    const KnownBody body = KnownBody::thrower();
    const KnownBody posed = body.posed(kTurns);
    EXPECT_GT(worstDistance(posed, body), 0.1 * heightOf(body));
    for (const Similarity& map : cases) {
        Turns turns;
        for (const auto& [joint, turn] : kTurns) turns[joint] = map(turn);
        const KnownBody result = body.mapped(map).posed(turns);
        const double worst =
            worstDistance(result, posed.mapped(map)) / (map.scale * heightOf(body));
        EXPECT_LT(worst, map.tolerance) << map.name;
        RecordProperty(map.name, std::to_string(worst));
    }
}

TEST(BindInvariance, PoseDoesNotDependOnJointOrder) {
    const KnownBody body = KnownBody::thrower();
    KnownBody other = body;
    other.truth = reordered(body.truth);
    ASSERT_EQ(other.truth.joints.size(), body.truth.joints.size());
    ASSERT_NE(other.truth.joints[1].name, body.truth.joints[1].name);
    EXPECT_LT(worstDistance(body.posed(kTurns), other.posed(kTurns)), 1e-5 * heightOf(body));
    // Rotations of both legs, which the skin between them follows in part, do not commute.
    Turns split = kTurns;
    split["LeftUpLeg"] = glm::angleAxis(1.0, glm::normalize(glm::dvec3(-1, 0, 1)));
    split["LowerBack"] = glm::angleAxis(0.5, glm::normalize(glm::dvec3(1, 1, 1)));
    EXPECT_LT(worstDistance(body.posed(split), other.posed(split)), 1e-5 * heightOf(body));
}

#ifdef OSGSKIN_HAS_TBB
TEST(BindInvariance, BindingDoesNotDependOnTheNumberOfThreads) {
    const KnownBody body = KnownBody::thrower();
    const auto boundBy = [&body](int threads) {
        Binding binding;
        tbb::task_arena(threads).execute([&] { binding = bind(body.mesh, body.truth); });
        return binding;
    };
    const Binding one = boundBy(1), four = boundBy(4);
    EXPECT_EQ(one.firstInfluence, four.firstInfluence);
    EXPECT_EQ(one.correctives.shares, four.correctives.shares);
    EXPECT_EQ(one.correctives.normalShares, four.correctives.normalShares);
    ASSERT_EQ(one.influences.size(), four.influences.size());
    ASSERT_EQ(one.gradients.size(), four.gradients.size());
    for (std::size_t i = 0; i < one.influences.size(); ++i) {
        EXPECT_EQ(one.influences[i].bend, four.influences[i].bend);
        EXPECT_EQ(one.influences[i].twist, four.influences[i].twist);
        EXPECT_EQ(one.gradients[i].bend, four.gradients[i].bend);
    }
}
#endif
