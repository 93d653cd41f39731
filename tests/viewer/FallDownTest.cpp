// SPDX-License-Identifier: MIT
// A figure falls down stairs: it comes to lie, on them, in one piece.
#include "Bodies.h"
#include "FindNodes.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinMotion/HitBoxes>

#include <osg/Geometry>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
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

/// How deep a point is in the stairs: below a tread or behind a riser, whichever is nearer.
double depthAt(const osg::Vec3d& at) {
    double depth = heightAt(at.y()) - at.z();
    for (double riser = -0.25 - 7 * 0.29; riser < 0.0; riser += 0.29)
        if (riser < at.y() && heightAt(riser - 0.01) <= at.z())
            depth = std::min(depth, at.y() - riser);
    return depth;
}

} // namespace

TEST(FallDown, EndsOnTheStairsInOnePiece) {
    const osg::ref_ptr<osg::Node> scene = fallDownStairs(OSGSKIN_DATA "/pedestrian.skin");
    test::updateAt(*scene, 0.0);
    const auto start = jointsOf(*scene);
    double deepest = -1.0;
    for (int frame = 1; frame <= 240; ++frame) {
        test::updateAt(*scene, frame / 60.0);
        for (const auto& skin : test::findNodes<osgSkin::DeformableSkin>(*scene)) {
            const auto& vertices = static_cast<const osg::Vec3Array&>(
                *skin.node->getDeformedGeometry()->getVertexArray());
            for (std::size_t v = 0; v < vertices.size(); v += 7) {
                const osg::Vec3d at = osg::Vec3d(vertices[v]) * skin.toWorld;
                ASSERT_TRUE(at.valid());
                deepest = std::max(deepest, depthAt(at));
            }
        }
    }
    const auto end = jointsOf(*scene);
    EXPECT_NEAR(start.at("Head").z(), 8 * 0.17 + 1.58, 0.1);
    EXPECT_LT(end.at("Head").z() - heightAt(end.at("Head").y()), 0.6);
    EXPECT_LT(end.at("Hips").z() - heightAt(end.at("Hips").y()), 0.5);
    EXPECT_LT(end.at("Hips").y(), -0.5) << "down the stairs";
    EXPECT_LT(deepest, 0.12) << "in the stairs";
    const auto length = [](const auto& joints, const char* a, const char* b) {
        return (joints.at(a) - joints.at(b)).length();
    };
    for (const auto& [a, b] : {std::pair{"LeftUpLeg", "LeftLeg"},
                               {"LeftLeg", "LeftFoot"},
                               {"RightArm", "RightForeArm"},
                               {"Neck", "Head"}})
        EXPECT_NEAR(length(end, a, b), length(start, a, b), 1e-3) << a;
}

TEST(FallDown, BendsElbowsAndKneesForwardsAloneAndNecksALittle) {
    for (int fall = 0; fall < 20; ++fall) {
        const double angle = 2.4 * fall, speed = 0.5 + 0.05 * fall;
        const osg::Vec3d push(std::sin(angle) * speed, -std::cos(angle) * speed, 0.0);
        const osg::ref_ptr<osg::Node> scene =
            fallDownStairs(OSGSKIN_DATA "/pedestrian.skin", 1.0, push);
        const osgSkin::HitBoxes* hits = nullptr;
        for (const auto& group : test::findNodes<osg::Group>(*scene))
            if (auto* found = osgSkin::find<osgSkin::HitBoxes>(*group.node)) hits = found;
        ASSERT_TRUE(hits);
        const auto motion = [&](const char* joint) {
            return hits->motion(std::size_t(hits->find(joint)));
        };
        for (int frame = 0; frame <= 180; ++frame) {
            test::updateAt(*scene, frame / 60.0);
            const auto joints = jointsOf(*scene);
            for (const auto& [upper, lower, end] :
                 {std::tuple{"LeftArm", "LeftForeArm", "LeftHand"},
                  {"RightArm", "RightForeArm", "RightHand"},
                  {"LeftUpLeg", "LeftLeg", "LeftFoot"},
                  {"RightUpLeg", "RightLeg", "RightFoot"}}) {
                osg::Vec3d above = joints.at(lower) - joints.at(upper),
                           below = joints.at(end) - joints.at(lower);
                above.normalize();
                below.normalize();
                const osg::Vec3d axis = osg::Matrixd::transform3x3(
                    hits->limbs()[std::size_t(hits->find(lower))].hinge, motion(upper));
                const double bend = std::atan2((above ^ below) * axis, above * below);
                EXPECT_GT(osg::RadiansToDegrees(bend), -5.0) << lower << " in fall " << fall;
            }
            const osg::Quat turn =
                (motion("Head") * osg::Matrixd::inverse(motion("Spine1"))).getRotate();
            double neck = 0.0;
            osg::Vec3d axis;
            turn.getRotate(neck, axis);
            neck = std::min(neck, 2.0 * osg::PI - neck);
            EXPECT_LT(osg::RadiansToDegrees(neck), 80.0) << "in fall " << fall;
        }
    }
}
