// SPDX-License-Identifier: MIT
// A figure falls down stairs: it comes to lie, on them, in one piece.
#include "Bodies.h"
#include "FindNodes.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>

#include <osg/Geometry>
#include <osgAnimation/Bone>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace {

std::map<std::string, osg::Vec3d> jointsOf(osg::Node& scene) {
    std::map<std::string, osg::Vec3d> result;
    for (const auto& bone : test::findNodes<osgAnimation::Bone>(scene))
        result[bone.node->getName()] = bone.toWorld.getTrans();
    return result;
}

/// The height of the stairs, which end at the floor.
double heightAt(double y) {
    const double steps = y > -0.25 ? 0.0 : std::ceil((-0.25 - y) / 0.29);
    return std::max(0.0, 0.17 * (8.0 - steps));
}

} // namespace

TEST(FallDown, EndsOnTheStairsInOnePiece) {
    const osg::ref_ptr<osg::Node> scene = fallDownStairs(OSGSKIN_DATA "/pedestrian.skin");
    test::updateAt(*scene, 0.0);
    const auto start = jointsOf(*scene);
    double lowest = 1.0;
    for (int frame = 1; frame <= 240; ++frame) {
        test::updateAt(*scene, frame / 60.0);
        for (const auto& skin : test::findNodes<osgSkin::DeformableSkin>(*scene)) {
            const auto& vertices = static_cast<const osg::Vec3Array&>(
                *skin.node->getDeformedGeometry()->getVertexArray());
            for (std::size_t v = 0; v < vertices.size(); v += 7) {
                const osg::Vec3d at = osg::Vec3d(vertices[v]) * skin.toWorld;
                ASSERT_TRUE(at.valid());
                lowest = std::min(lowest, at.z() - heightAt(at.y()));
            }
        }
    }
    const auto end = jointsOf(*scene);
    EXPECT_NEAR(start.at("Head").z(), 8 * 0.17 + 1.58, 0.1);
    EXPECT_LT(end.at("Head").z() - heightAt(end.at("Head").y()), 0.6);
    EXPECT_LT(end.at("Hips").z() - heightAt(end.at("Hips").y()), 0.5);
    EXPECT_LT(end.at("Hips").y(), -0.5) << "down the stairs";
    EXPECT_GT(lowest, -0.12) << "into the stairs";
    const auto length = [](const auto& joints, const char* a, const char* b) {
        return (joints.at(a) - joints.at(b)).length();
    };
    for (const auto& [a, b] : {std::pair{"LeftUpLeg", "LeftLeg"},
                               {"LeftLeg", "LeftFoot"},
                               {"RightArm", "RightForeArm"},
                               {"Neck", "Head"}})
        EXPECT_NEAR(length(end, a, b), length(start, a, b), 1e-3) << a;
}
