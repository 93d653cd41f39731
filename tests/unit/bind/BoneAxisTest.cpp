// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "Shapes.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

using namespace osgSkin;

namespace {

/// Only the skeleton matters here.
glm::dvec3 boneAxis(const RestSkeleton& skeleton, const std::string& joint) {
    const Binding binding = bind(shapes::cylinder(), skeleton);
    return binding.joints[jointCalled(binding, joint)].boneAxis;
}

RestSkeleton body() {
    RestSkeleton s;
    shapes::addJoint(s, "Hips", "", {0, 1, 0});
    shapes::addJoint(s, "LHipJoint", "Hips", {0, 1, 0}); // no length
    shapes::addJoint(s, "LeftUpLeg", "LHipJoint", {0.5, 0.9, 0});
    shapes::addJoint(s, "LeftLeg", "LeftUpLeg", {0.5, 0.1, 0});
    shapes::addJoint(s, "Spine", "Hips", {0, 2, -0.1});
    shapes::addJoint(s, "Spine1", "Spine", {0, 3, 0});
    shapes::addJoint(s, "LeftShoulder", "Spine1", {0.2, 3.8, 0.3});
    shapes::addJoint(s, "RightShoulder", "Spine1", {-0.2, 3.8, 0.3});
    shapes::addJoint(s, "Neck", "Spine1", {0, 4.2, 0});
    shapes::addJoint(s, "Head", "Neck", {0, 5, 0});
    s.joints.back().tip = glm::dvec3(0, 6, 0.2);
    shapes::addJoint(s, "LeftHand", "LeftShoulder", {3, 3.8, 0});
    shapes::addJoint(s, "LeftHandThumb", "LeftHand", {3.5, 3.8, 0.01}); // in line, except for a
                                                                        // thumb
    shapes::addJoint(s, "LeftHandIndex", "LeftHand", {3.8, 3.6, 0.2});
    shapes::addJoint(s, "Tail", "LeftHandIndex", {4.4, 3.4, 0.3});
    return s;
}

} // namespace

TEST(BoneAxis, PointsAlongTheChain) {
    const RestSkeleton s = body();
    const auto towards = [&s](const std::string& from, const std::string& to) {
        const auto centre = [&s](const std::string& name) {
            return s.joints[static_cast<std::size_t>(s.find(name))].centre;
        };
        return glm::normalize(centre(to) - centre(from));
    };
    const char* const pairs[][2] = {{"Hips", "Spine"},
                                    {"LHipJoint", "LeftUpLeg"},
                                    {"LeftUpLeg", "LeftLeg"},
                                    {"Spine1", "Neck"},
                                    {"LeftHand", "LeftHandIndex"}};
    for (const auto& [from, to] : pairs)
        EXPECT_LT(glm::distance(boneAxis(s, from), towards(from, to)), 1e-12)
            << from << " should point to " << to;
    EXPECT_LT(glm::distance(boneAxis(s, "Head"), glm::normalize(glm::dvec3(0, 1, 0.2))), 1e-12);
    EXPECT_LT(glm::distance(boneAxis(s, "Tail"), boneAxis(s, "LeftHandIndex")), 1e-12)
        << "a leaf without a tip goes on like its parent";
}

TEST(BoneAxis, SingleJointPointsUp) {
    RestSkeleton s;
    shapes::addJoint(s, "only", "", {0, 1, 0});
    EXPECT_EQ(boneAxis(s, "only"), glm::dvec3(0, 1, 0));
}
