// SPDX-License-Identifier: MIT
#include "Notices.h"
#include "TubeSkin.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/UpdateDeformableSkin>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

using osgSkin::Pose;
using test::makeBones;
using test::makeSkin;
using test::verticesOf;

TEST(Pose, RejectsInvalidMatricesAndKeepsThePose) {
    const test::Tube tube(3, 3);
    Pose pose(tube.binding.joints);
    std::vector<glm::dmat4> skinning(3, glm::dmat4(1.0));
    skinning[1] = glm::mat4_cast(glm::angleAxis(0.5, glm::dvec3(1, 0, 0)));
    ASSERT_TRUE(pose.set(skinning.data(), 3));
    const glm::dquat before = pose.transform(1).rotation;

    EXPECT_FALSE(pose.set(skinning.data(), 2));
    auto spoilt = skinning;
    spoilt[1][3][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(pose.set(spoilt.data(), 3));
    spoilt = skinning;
    spoilt[2] = glm::dmat4(0.0);
    EXPECT_FALSE(pose.set(spoilt.data(), 3));
    EXPECT_EQ(pose.transform(1).rotation, before);
}

TEST(Pose, SeparatesUniformScale) {
    const test::Tube tube(3, 3);
    Pose pose(tube.binding.joints);
    const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
    std::vector<glm::dmat4> skinning(3, glm::mat4_cast(turn) *
                                            glm::scale(glm::dmat4(1.0), glm::dvec3(2.0)));
    skinning[2] = skinning[1] * glm::scale(glm::dmat4(1.0), glm::dvec3(1.5));
    ASSERT_TRUE(pose.set(skinning.data(), 3));
    EXPECT_NEAR(std::abs(glm::dot(pose.transform(0).rotation, turn)), 1.0, 1e-12);
    EXPECT_NEAR(std::abs(pose.transform(1).rotation.w), 1.0, 1e-12);
    EXPECT_NEAR(pose.transform(0).scale, 2.0, 1e-12);
    EXPECT_EQ(pose.transform(1).scale, 1.0) << "exactly: it costs nothing then";
    EXPECT_NEAR(pose.transform(2).scale, 1.5, 1e-12);
}

TEST(Pose, IgnoresNonUniformScaleAndMirroring) {
    const test::Tube tube(3, 3);
    Pose pose(tube.binding.joints);
    for (const glm::dvec3& scale : {glm::dvec3(2.0, 0.5, 1.0), glm::dvec3(-1.0, 1.0, 1.0)}) {
        std::vector<glm::dmat4> skinning(3, glm::dmat4(1.0));
        skinning[1] = glm::scale(glm::dmat4(1.0), scale);
        ASSERT_TRUE(pose.set(skinning.data(), 3));
        EXPECT_EQ(pose.transform(1).scale, 1.0);
        const glm::dvec3 centre = tube.binding.joints[1].centre;
        EXPECT_LT(glm::distance(pose.transform(1).translation,
                                glm::dvec3(skinning[1] * glm::dvec4(centre, 1.0)) - centre),
                  1e-12)
            << "the joint itself goes where the bone puts it";
    }
}

TEST(Pose, ReturnsTheMatricesItWasSetFrom) {
    const test::Tube tube(3, 3);
    Pose pose(tube.binding.joints);
    std::mt19937_64 random(17);
    std::vector<glm::dmat4> skinning;
    for (int j = 0; j < 3; ++j) {
        const glm::dmat4 own = glm::translate(glm::dmat4(1.0), test::randomUnit(random)) *
                               glm::mat4_cast(test::randomRotation(random)) *
                               glm::scale(glm::dmat4(1.0), glm::dvec3(0.5 + j));
        skinning.push_back(j == 0 ? own : skinning.back() * own);
    }
    ASSERT_TRUE(pose.set(skinning.data(), 3));
    const std::vector<glm::dmat4> back = pose.skinning();
    ASSERT_EQ(back.size(), 3u);
    for (std::size_t j = 0; j < 3; ++j)
        for (int column = 0; column < 4; ++column)
            EXPECT_LT(glm::distance(back[j][column], skinning[j][column]), 1e-12) << j << column;
    EXPECT_TRUE(Pose().skinning().empty());
}

namespace {

using Matrices = std::vector<glm::dmat4>;

bool areFinite(const osgSkin::DeformableSkin& skin) {
    for (const osg::Vec3& p : verticesOf(skin))
        if (p.isNaN() || !std::isfinite(p.length2())) return false;
    for (const osg::Vec3& n :
         dynamic_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getNormalArray())
             .asVector())
        if (n.isNaN() || !std::isfinite(n.length2())) return false;
    return skin.getBoundingBox().valid() && std::isfinite(skin.getBound().radius());
}

} // namespace

TEST(InvalidPose, RestPoseGivesExactRestPositions) {
    const auto skin = makeSkin();
    ASSERT_TRUE(skin->setPose(Matrices(3, glm::dmat4(1.0)).data(), 3));
    const auto& rest =
        dynamic_cast<const osg::Vec3Array&>(*skin->getRestGeometry()->getVertexArray());
    const std::vector<osg::Vec3> posed = verticesOf(*skin);
    ASSERT_EQ(posed.size(), rest.size());
    EXPECT_EQ(std::memcmp(posed.data(), rest.asVector().data(), posed.size() * sizeof(osg::Vec3)),
              0);
}

/// Invalid poses are refused, and the last good pose stays; valid ones give finite results.
TEST(InvalidPose, RejectsUnusableMatricesAndStaysFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const auto scaled = [](double x, double y, double z) {
        return glm::scale(glm::dmat4(1.0), glm::dvec3(x, y, z));
    };
    const auto moved = [](double x) {
        return glm::translate(glm::dmat4(1.0), glm::dvec3(x, 0.0, 0.0));
    };
    glm::dmat4 lastRow(1.0), sheared(1.0), projection(1.0);
    lastRow[1][3] = nan;
    sheared[1][0] = 3.0;
    projection[2][3] = -1.0;
    const std::pair<glm::dmat4, bool> cases[] = {
        {scaled(2, 2, 2), true},
        {scaled(1e-4, 1e-4, 1e-4), true},
        {scaled(1e4, 1e4, 1e4), true},
        {scaled(1, 2, 0.5), true},
        {sheared, true},
        {scaled(-1, 1, 1), true},
        {moved(1e5), true},
        {moved(1e17), true},
        {moved(1e39), false},
        {moved(1e300), false},
        {scaled(0, 0, 0), false},
        {scaled(1, 1, 0), false},
        {scaled(1e38, 1e38, 1e38), false},
        {scaled(nan, 1, 1), false},
        {moved(nan), false},
        {moved(infinity), false},
        {lastRow, false},
        {projection, false},
        {scaled(1e-300, 1e-300, 1e-300), false},
    };
    for (std::size_t joint = 0; joint < 3; ++joint)
        for (const auto& [matrix, followed] : cases) {
            const auto skin = makeSkin();
            test::bend(*skin, 0.7);
            const std::vector<osg::Vec3> before = verticesOf(*skin);
            Matrices matrices(3, glm::dmat4(1.0));
            matrices[joint] = matrix;
            EXPECT_EQ(skin->setPose(matrices.data(), 3), followed) << joint << " " << matrix[0][0];
            EXPECT_TRUE(areFinite(*skin)) << joint << " " << matrix[0][0] << " " << matrix[3][0];
            if (!followed) {
                EXPECT_EQ(verticesOf(*skin), before);
            }
        }
}

/// The same for poses without matrices, joint by joint.
TEST(InvalidPose, RejectsJointMapsOutOfRange) {
    const auto map = [](double offset, double scale) {
        osgSkin::JointMap made;
        made.offset = {0.0, offset, 0.0};
        made.scale = scale;
        return made;
    };
    using Maps = std::vector<osgSkin::JointMap>;
    const std::pair<Maps, bool> cases[] = {
        {{map(1e17, 1.0), map(0.0, 1.0), map(0.0, 1.0)}, true},
        {{map(0.0, 1e4), map(0.0, 1e-4), map(1.0, 1e4)}, true},
        {{map(1e39, 1.0), map(0.0, 1.0), map(0.0, 1.0)}, false},
        {{map(0.0, 1.0), map(0.0, 1.0), map(1e300, 1.0)}, false},
        {{map(0.0, 1e38), map(0.0, 1.0), map(0.0, 1.0)}, false},
        {{map(0.0, 1e-38), map(0.0, 1.0), map(0.0, 1.0)}, false},
        {{map(0.0, 1e7), map(0.0, 1e7), map(0.0, 1e7)}, false}, // only together, as in the next
                                                                // case
        {{map(0.0, 1e-7), map(0.0, 1e-7), map(0.0, 1e-7)}, false},
        {{map(0.0, 1e6), map(0.0, 1.0), map(1e17, 1.0)}, false},
    };
    for (const auto& [maps, followed] : cases) {
        const auto skin = makeSkin();
        test::bend(*skin, 0.7);
        const std::vector<osg::Vec3> before = verticesOf(*skin);
        EXPECT_EQ(skin->setPose(maps.data(), maps.size()), followed)
            << maps[0].offset.y << " " << maps[0].scale << " " << maps[2].offset.y;
        EXPECT_TRUE(areFinite(*skin)) << maps[0].offset.y << " " << maps[0].scale;
        EXPECT_EQ(verticesOf(*skin) == before, !followed);
    }
}

/// A vertex follows several joints by shares: scales that each may have can be too large together.
TEST(InvalidPose, RejectsCombinedScalesOutOfRange) {
    std::mt19937 random(31);
    std::uniform_real_distribution<double> exponent(-8.9, 8.9);
    int followed = 0;
    for (int i = 0; i < 300; ++i) {
        const auto skin = makeSkin();
        Matrices matrices;
        std::string scales;
        for (int j = 0; j < 3; ++j) {
            const double scale = i % 2 == 0 ? 1.0 : std::pow(10.0, exponent(random));
            const double scaleOfTwo = j == 0 ? 1.0 : std::pow(10.0, exponent(random) / 3.0);
            matrices.push_back(glm::scale(glm::dmat4(1.0), glm::dvec3(scale * scaleOfTwo)));
            scales += " " + std::to_string(std::log10(scale * scaleOfTwo));
        }
        if (!skin->setPose(matrices.data(), 3)) continue;
        ++followed;
        EXPECT_TRUE(areFinite(*skin)) << scales;
        const osg::BoundingBox box = skin->getBoundingBox();
        for (const osg::Vec3& p : verticesOf(*skin)) EXPECT_TRUE(box.contains(p)) << scales;
    }
    EXPECT_GT(followed, 150);
    const auto scaled = [](double by) { return glm::scale(glm::dmat4(1.0), glm::dvec3(by)); };
    const auto skin = makeSkin();
    EXPECT_TRUE(skin->setPose(Matrices{scaled(1e-9), scaled(1.0), scaled(1.0)}.data(), 3));
    EXPECT_TRUE(skin->setPose(Matrices{scaled(1e-8), scaled(1.0), scaled(1e3)}.data(), 3));
    EXPECT_FALSE(skin->setPose(Matrices{scaled(1e-8), scaled(1.0), scaled(1e8)}.data(), 3));
}

TEST(InvalidPose, WarnsOnceAboutAnInvalidBone) {
    const auto skin = makeSkin();
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    const auto bones = makeBones();
    EXPECT_TRUE(update->pose(*skin, *bones));
    const std::vector<osg::Vec3> before = verticesOf(*skin);
    auto& root = dynamic_cast<osgAnimation::Bone&>(*bones->getChild(0));
    root.setMatrixInSkeletonSpace(osg::Matrix::scale(0, 0, 0));
    const test::Notices notices;
    for (int frame = 0; frame < 5; ++frame) EXPECT_FALSE(update->pose(*skin, *bones));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
    EXPECT_TRUE(notices.say("the last pose stays")) << notices.text();
    EXPECT_EQ(verticesOf(*skin), before);
}
