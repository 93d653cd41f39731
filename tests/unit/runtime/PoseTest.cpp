// SPDX-License-Identifier: MIT
//
// Invalid poses, and poses that must not be confused with each other.
#include "Notices.h"
#include "Tube.h"
#include "TubeSkin.h"
#include "Turns.h"

#include <osgSkin/BendTwist>
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinRig/Prop>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/Retarget>
#include <osgSkinRig/SkinMesh>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

using osgSkin::BendTwist;
using osgSkin::partialRotation;
using osgSkin::splitBendTwist;

namespace {

const double kPi = glm::pi<double>();
const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

glm::dquat turn(const glm::dvec3& axis, double angle) {
    return glm::angleAxis(angle, axis);
}

/// Distance between two rotations as quaternions, up to sign.
double distance(const glm::dquat& a, const glm::dquat& b) {
    const auto length = [](const glm::dquat& q) { return std::sqrt(glm::dot(q, q)); };
    return std::min(length(a - b), length(a + b));
}

double recompositionError(const glm::dquat& q, const glm::dvec3& pole) {
    const BendTwist split = splitBendTwist(q, pole);
    return distance(partialRotation(split, pole, 1.0, 1.0), glm::normalize(q));
}

bool isFinite(const BendTwist& s) {
    return std::isfinite(s.bendAngle) && std::isfinite(s.twistAngle) &&
           std::isfinite(s.bendAxis.x) && std::isfinite(s.bendAxis.y) &&
           std::isfinite(s.bendAxis.z);
}

} // namespace

TEST(BendTwist, MillionRandomRotationsRecompose) {
    std::mt19937_64 random(1);
    double recomposition = 0.0;
    double perpendicular = 0.0;
    for (int i = 0; i < 1000000; ++i) {
        const glm::dquat q = test::randomRotation(random);
        const glm::dvec3 w = test::randomUnit(random);
        const BendTwist split = splitBendTwist(q, w);
        recomposition = std::max(recomposition, distance(partialRotation(split, w, 1.0, 1.0), q));
        perpendicular = std::max(perpendicular, std::abs(glm::dot(split.bendAxis, w)));
        ASSERT_GE(split.bendAngle, 0.0);
        ASSERT_LE(split.bendAngle, kPi);
        ASSERT_LE(std::abs(split.twistAngle), kPi);
        ASSERT_NEAR(glm::length(split.bendAxis), 1.0, 1e-12);
    }
    EXPECT_LE(recomposition, 1e-12);
    EXPECT_LE(perpendicular, 1e-12);
}

TEST(BendTwist, NearEdgesRecompose) {
    std::mt19937_64 random(2);
    for (const double near : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-30, 0.0})
        for (const double bend : {near, kPi - near, kPi / 2})
            for (const double twist : {near, -near, kPi - near, -kPi + near, 1.0})
                for (int i = 0; i < 50; ++i) {
                    const glm::dvec3 w = test::randomUnit(random);
                    const glm::dvec3 v = glm::normalize(glm::cross(w, test::randomUnit(random)));
                    const glm::dquat q = turn(v, bend) * turn(w, twist);
                    const BendTwist split = splitBendTwist(q, w);
                    ASSERT_TRUE(isFinite(split)) << bend << ' ' << twist;
                    ASSERT_LE(std::abs(glm::dot(split.bendAxis, w)), 1e-12);
                    ASSERT_LE(recompositionError(q, w), 1e-12) << bend << ' ' << twist;
                }
}

TEST(BendTwist, ExactEdges) {
    const glm::dvec3 w(0, 1, 0);
    struct Case {
        const char* name;
        glm::dquat q;
        double bend, twist;
    };
    const Case cases[] = {
        {"identity", {1, 0, 0, 0}, 0, 0},
        {"360 degrees", {-1, 0, 0, 0}, 0, 0},
        {"twist of 180 degrees", {0, 0, 1, 0}, 0, kPi},
        {"twist of -180 degrees", {0, 0, -1, 0}, 0, kPi},
        {"bend of 180 degrees", {0, 1, 0, 0}, kPi, 0},
        {"bend of 180 degrees about z", {0, 0, 0, -1}, kPi, 0},
        {"twist of 90 degrees", {std::sqrt(0.5), 0, std::sqrt(0.5), 0}, 0, kPi / 2},
        {"bend of 90 degrees", {std::sqrt(0.5), std::sqrt(0.5), 0, 0}, kPi / 2, 0},
    };
    for (const Case& c : cases) {
        const BendTwist split = splitBendTwist(c.q, w);
        EXPECT_NEAR(split.bendAngle, c.bend, 1e-15) << c.name;
        EXPECT_NEAR(split.twistAngle, c.twist, 1e-15) << c.name;
        EXPECT_EQ(glm::dot(split.bendAxis, w), 0.0) << c.name;
        EXPECT_LE(recompositionError(c.q, w), 1e-15) << c.name;
    }
}

TEST(BendTwist, NegatedQuaternionIsTheSameRotation) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 10000; ++i) {
        glm::dquat q = test::randomRotation(random);
        if (i % 4 == 1) q = glm::dquat(0, glm::normalize(glm::dvec3(q.x, q.y, q.z)));
        const glm::dvec3 w = i % 4 == 2 ? glm::dvec3(0, 0, 1) : test::randomUnit(random);
        const BendTwist a = splitBendTwist(q, w);
        const BendTwist b = splitBendTwist(-q, w);
        ASSERT_EQ(a.bendAngle, b.bendAngle);
        ASSERT_EQ(a.twistAngle, b.twistAngle);
        ASSERT_EQ(a.bendAxis, b.bendAxis);
    }
}

TEST(BendTwist, LengthDoesNotMatter) {
    std::mt19937_64 random(4);
    for (const double scale : {1e-300, 1e-30, 0.5, 3.0, 1e30, 1e300}) {
        const glm::dquat q = test::randomRotation(random);
        const glm::dvec3 w = test::randomUnit(random);
        const BendTwist a = splitBendTwist(q, w);
        const BendTwist b = splitBendTwist(q * scale, w);
        EXPECT_NEAR(a.bendAngle, b.bendAngle, 1e-12) << scale;
        EXPECT_NEAR(a.twistAngle, b.twistAngle, 1e-12) << scale;
    }
}

TEST(BendTwist, RefusesWhatIsNoRotation) {
    const glm::dvec3 w(0, 1, 0);
    const glm::dquat good(1, 0, 0, 0);
    for (const double bad : {kNan, kInf, -kInf}) {
        for (int part = 0; part < 4; ++part) {
            glm::dquat q = good;
            q[part] = bad;
            EXPECT_THROW(splitBendTwist(q, w), osgSkin::Error);
        }
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 pole = w;
            pole[axis] = bad;
            EXPECT_THROW(splitBendTwist(good, pole), osgSkin::Error);
        }
    }
    EXPECT_THROW(splitBendTwist(glm::dquat(0, 0, 0, 0), w), osgSkin::Error);
    EXPECT_THROW(splitBendTwist(good, glm::dvec3(0)), osgSkin::Error);
    EXPECT_THROW(splitBendTwist(good, glm::dvec3(0, 2, 0)), osgSkin::Error);

    BendTwist untouched{{0, 0, 1}, 0.5, 0.25};
    EXPECT_FALSE(osgSkin::trySplitBendTwist(glm::dquat(kNan, 0, 0, 0), w, untouched));
    EXPECT_EQ(untouched.bendAngle, 0.5);
    EXPECT_EQ(untouched.twistAngle, 0.25);
}

TEST(BendTwist, RatiosTakeSharesOfTheAngles) {
    const glm::dvec3 w(0, 1, 0);
    const glm::dvec3 v(1, 0, 0);
    const BendTwist split = splitBendTwist(turn(v, 1.2) * turn(w, -0.8), w);
    EXPECT_NEAR(split.bendAngle, 1.2, 1e-14);
    EXPECT_NEAR(split.twistAngle, -0.8, 1e-14);
    EXPECT_EQ(distance(partialRotation(split, w, 0.0, 0.0), glm::dquat(1, 0, 0, 0)), 0.0);
    EXPECT_LE(distance(partialRotation(split, w, 0.5, 0.25), turn(v, 0.6) * turn(w, -0.2)), 1e-14);
}

namespace {

/// The message of the Error that validate() throws; empty if none.
template <typename T>
std::string complaint(const T& value) {
    try {
        value.validate();
        return "";
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
}

} // namespace

TEST(RestSkeleton, DefaultIsInvalid) {
    EXPECT_NE(complaint(osgSkin::RestSkeleton()), "");
}

TEST(RestSkeleton, ValidateNamesTheJoint) {
    struct Case {
        const char* name;
        std::vector<osgSkin::RestJoint> joints;
        const char* names;
    };
    const Case cases[] = {
        {"first has a parent", {{"a", 0, {}, {}}}, "\"a\""},
        {"two roots", {{"a", -1, {}, {}}, {"b", -1, {}, {}}}, "\"b\""},
        {"cycle", {{"a", -1, {}, {}}, {"b", 2, {}, {}}, {"c", 1, {}, {}}}, "\"b\""},
        {"own parent", {{"a", -1, {}, {}}, {"b", 1, {}, {}}}, "\"b\""},
        {"one name twice", {{"a", -1, {}, {}}, {"a", 0, {}, {}}}, "joint 1 \"a\""},
        {"not finite", {{"a", -1, {}, {}}, {"b", 0, {0, std::nan(""), 0}, {}}}, "\"b\""},
    };
    for (const Case& c : cases)
        EXPECT_NE(complaint(osgSkin::RestSkeleton{c.joints}).find(c.names), std::string::npos)
            << c.name << ": " << complaint(osgSkin::RestSkeleton{c.joints});
    EXPECT_EQ(complaint(osgSkin::RestSkeleton{{{"a", -1, {}, {}}, {"b", 0, {}, {}}}}), "");
}

TEST(RestSkeleton, KnowsItsTree) {
    const osgSkin::RestSkeleton skeleton{
        {{"a", -1, {}, {}}, {"b", 0, {}, {}}, {"c", 1, {}, {}}, {"d", 0, {}, {}}}};
    EXPECT_EQ(skeleton.find("c"), 2);
    EXPECT_EQ(skeleton.find("x"), -1);
    EXPECT_EQ(skeleton.children(0), (std::vector<int>{1, 3}));
    EXPECT_TRUE(skeleton.isInSubtree(2, 1));
    EXPECT_TRUE(skeleton.isInSubtree(2, 2));
    EXPECT_FALSE(skeleton.isInSubtree(3, 1));
}

TEST(Motion, WhatIsNotWholeIsRefused) {
    osgSkin::Motion good;
    good.name = "wave";
    good.skeleton.add("a", -1, glm::dvec3(0, 1, 0));
    good.skeleton.add("b", 0, glm::dvec3(0, 2, 0));
    good.frameTime = 0.1;
    const std::vector<glm::dquat> still(2, glm::dquat(1, 0, 0, 0));
    for (int f = 0; f < 3; ++f) good.addFrame(glm::dvec3(0, 1, 0), still);
    ASSERT_EQ(complaint(good), "");
    struct Case {
        const char* name;
        void (*spoil)(osgSkin::Motion&);
        const char* names;
    };
    const Case cases[] = {
        {"skeleton", [](osgSkin::Motion& m) { m.skeleton.joints[1].parent = 1; }, "\"b\""},
        {"no frame", [](osgSkin::Motion& m) { m.frames = 0; }, "no frame"},
        {"no time", [](osgSkin::Motion& m) { m.frameTime = 0.0; }, "frame time"},
        {"time", [](osgSkin::Motion& m) { m.frameTime = std::nan(""); }, "frame time"},
        {"endless", [](osgSkin::Motion& m) { m.frameTime = HUGE_VAL; }, "frame time"},
        {"more frames", [](osgSkin::Motion& m) { m.frames = 4; }, "do not fit 4"},
        {"fewer roots", [](osgSkin::Motion& m) { m.rootPositions.pop_back(); }, "do not fit"},
        {"fewer turns", [](osgSkin::Motion& m) { m.rotations.pop_back(); }, "do not fit"},
        {"root", [](osgSkin::Motion& m) { m.rootPositions[2].x = std::nan(""); },
         "frame 2: the root"},
        {"far", [](osgSkin::Motion& m) { m.rootPositions[1].y = 1e300; }, "frame 1: the root"},
        {"turn", [](osgSkin::Motion& m) { m.rotations[3].w = std::nan(""); },
         "frame 1: joint \"b\""},
        {"longer", [](osgSkin::Motion& m) { m.rotations[4].w = 2.0; }, "frame 2: joint \"a\""},
    };
    for (const Case& c : cases) {
        osgSkin::Motion motion = good;
        c.spoil(motion);
        EXPECT_NE(complaint(motion).find(c.names), std::string::npos)
            << c.name << ": " << complaint(motion);
        osgSkin::RetargetReport report;
        EXPECT_THROW(osgSkin::retarget(motion, good.skeleton, {}, &report), osgSkin::Error);
        const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
        EXPECT_THROW(osgSkin::makeProp("ball", {}, motion, report, *animation), osgSkin::Error);
        EXPECT_TRUE(animation->getChannels().empty());
    }
}

TEST(SkinMesh, ValidateNamesThePlace) {
    const std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    struct Case {
        const char* name;
        osgSkin::SkinMesh mesh;
        const char* names;
    };
    const Case cases[] = {
        {"empty", {}, "no vertex"},
        {"no face", {points, {}, {}}, "no face"},
        {"not finite", {{{0, 0, 0}, {1, std::nan(""), 0}, {0, 1, 0}}, {3}, {0, 1, 2}}, "vertex 1"},
        {"two corners", {points, {2}, {0, 1}}, "face 0"},
        {"index beyond", {points, {3, 3}, {0, 1, 2, 0, 1, 3}}, "face 1"},
        {"corners missing", {points, {3, 3}, {0, 1, 2, 0}}, "face 1"},
        {"corners left over", {points, {3}, {0, 1, 2, 0}}, "beyond"},
        {"huge face", {points, {0xffffffffu}, {0, 1, 2}}, "face 0"},
    };
    for (const Case& c : cases)
        EXPECT_NE(complaint(c.mesh).find(c.names), std::string::npos)
            << c.name << ": " << complaint(c.mesh);
    EXPECT_EQ(complaint(osgSkin::SkinMesh{points, {3}, {0, 1, 2}}), "");
}

TEST(SkinMesh, FansPolygons) {
    const osgSkin::SkinMesh mesh{std::vector<glm::dvec3>(5), {3, 4}, {0, 1, 2, 1, 2, 3, 4}};
    EXPECT_EQ(mesh.triangles(), (std::vector<std::uint32_t>{0, 1, 2, 1, 2, 3, 1, 3, 4}));
}

TEST(Binding, ValidateNamesThePlace) {
    const osgSkin::Binding good = test::Tube(3, 3).binding;
    ASSERT_EQ(complaint(good), "");
    EXPECT_NE(complaint(osgSkin::Binding()), "");
    struct Case {
        const char* name;
        void (*spoil)(osgSkin::Binding&);
        const char* names;
    };
    const Case cases[] = {
        {"parent after child", [](osgSkin::Binding& b) { b.joints[1].parent = 2; }, "\"middle\""},
        {"axis", [](osgSkin::Binding& b) { b.joints[2].twistAxis *= 2.0; }, "\"end\""},
        {"region", [](osgSkin::Binding& b) { b.regions[4] = 9; }, "vertex 4"},
        {"ratio", [](osgSkin::Binding& b) { b.influences.back().twist = 1.5f; }, "vertex 8"},
        {"order", [](osgSkin::Binding& b) { b.influences.back().joint = 0; }, "vertex 8"},
        {"root", [](osgSkin::Binding& b) { b.influences[0].bend = 0.5f; }, "vertex 0"},
        {"offsets", [](osgSkin::Binding& b) { b.firstInfluence.back() = 3; }, "offsets"},
    };
    for (const Case& c : cases) {
        osgSkin::Binding binding = good;
        c.spoil(binding);
        EXPECT_NE(complaint(binding).find(c.names), std::string::npos)
            << c.name << ": " << complaint(binding);
    }
}

using test::makeBones;
using test::makeSkin;

namespace {

using Matrices = std::vector<glm::dmat4>;

std::vector<osg::Vec3> positionsOf(const osgSkin::DeformableSkin& skin) {
    const auto& array =
        dynamic_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray());
    return array.asVector();
}

bool areFinite(const osgSkin::DeformableSkin& skin) {
    for (const osg::Vec3& p : positionsOf(skin))
        if (p.isNaN() || !std::isfinite(p.length2())) return false;
    for (const osg::Vec3& n :
         dynamic_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getNormalArray())
             .asVector())
        if (n.isNaN() || !std::isfinite(n.length2())) return false;
    return skin.getBoundingBox().valid() && std::isfinite(skin.getBound().radius());
}

} // namespace

TEST(PoseTrust, TheRestPoseIsTheRestToTheBit) {
    const auto skin = makeSkin();
    ASSERT_TRUE(skin->setPose(Matrices(3, glm::dmat4(1.0)).data(), 3));
    const auto& rest =
        dynamic_cast<const osg::Vec3Array&>(*skin->getRestGeometry()->getVertexArray());
    const std::vector<osg::Vec3> posed = positionsOf(*skin);
    ASSERT_EQ(posed.size(), rest.size());
    EXPECT_EQ(std::memcmp(posed.data(), rest.asVector().data(), posed.size() * sizeof(osg::Vec3)),
              0);
}

/// Invalid poses are refused, and the last good pose stays; valid ones give finite results.
TEST(PoseTrust, NothingThatIsDrawnIsNoNumber) {
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
            const std::vector<osg::Vec3> before = positionsOf(*skin);
            Matrices matrices(3, glm::dmat4(1.0));
            matrices[joint] = matrix;
            EXPECT_EQ(skin->setPose(matrices.data(), 3), followed) << joint << " " << matrix[0][0];
            EXPECT_TRUE(areFinite(*skin)) << joint << " " << matrix[0][0] << " " << matrix[3][0];
            if (!followed) {
                EXPECT_EQ(positionsOf(*skin), before);
            }
        }
}

/// The same for poses without matrices, joint by joint.
TEST(PoseTrust, JointMapsBeyondAllNumbersAreRefused) {
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
        const std::vector<osg::Vec3> before = positionsOf(*skin);
        EXPECT_EQ(skin->setPose(maps.data(), maps.size()), followed)
            << maps[0].offset.y << " " << maps[0].scale << " " << maps[2].offset.y;
        EXPECT_TRUE(areFinite(*skin)) << maps[0].offset.y << " " << maps[0].scale;
        EXPECT_EQ(positionsOf(*skin) == before, !followed);
    }
}

/// A vertex follows several joints by shares: scales that each may have can be too large together.
TEST(PoseTrust, JointsTogetherKeepVerticesInRange) {
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
        for (const osg::Vec3& p : positionsOf(*skin)) EXPECT_TRUE(box.contains(p)) << scales;
    }
    EXPECT_GT(followed, 150);
    const auto scaled = [](double by) { return glm::scale(glm::dmat4(1.0), glm::dvec3(by)); };
    const auto skin = makeSkin();
    EXPECT_TRUE(skin->setPose(Matrices{scaled(1e-9), scaled(1.0), scaled(1.0)}.data(), 3));
    EXPECT_TRUE(skin->setPose(Matrices{scaled(1e-8), scaled(1.0), scaled(1e3)}.data(), 3));
    EXPECT_FALSE(skin->setPose(Matrices{scaled(1e-8), scaled(1.0), scaled(1e8)}.data(), 3));
}

TEST(PoseTrust, ABoneThatCannotBeFollowedIsWarnedOfOnce) {
    const auto skin = makeSkin();
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    const auto bones = makeBones();
    EXPECT_TRUE(update->pose(*skin, *bones));
    const std::vector<osg::Vec3> before = positionsOf(*skin);
    auto& root = dynamic_cast<osgAnimation::Bone&>(*bones->getChild(0));
    root.setMatrixInSkeletonSpace(osg::Matrix::scale(0, 0, 0));
    const test::Notices notices;
    for (int frame = 0; frame < 5; ++frame) EXPECT_FALSE(update->pose(*skin, *bones));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
    EXPECT_TRUE(notices.say("the last pose stays")) << notices.text();
    EXPECT_EQ(positionsOf(*skin), before);
}

/// Memory is reused: a new model may have the address of an old one.
TEST(PoseTrust, AModelIsNotItsAddress) {
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    const auto bones = makeBones();
    dynamic_cast<osgAnimation::Bone&>(*bones->getChild(0))
        .setMatrixInSkeletonSpace(osg::Matrix::rotate(0.5, 0, 0, 1));
    const test::Tube tube(4, 12);
    const osg::ref_ptr<osg::Geometry> geometry = test::makeGeometry(tube);
    osgSkin::Binding renamed = tube.binding; // other bones for the same joints
    std::swap(renamed.joints[0].name, renamed.joints[1].name);
    const auto skin = makeSkin();
    skin->setSkin(geometry, tube.model());
    ASSERT_TRUE(update->pose(*skin, *bones));
    const void* const place = skin->getModel();
    skin->setSkin(geometry, tube.model()); // frees the model
    std::vector<osg::ref_ptr<const osgSkin::SkinModel>> others;
    do
        others.push_back(
            osgSkin::SkinModel::create(renamed, tube.positions, tube.normals, tube.source));
    while (others.back() != place && others.size() < 3000);
    skin->setSkin(geometry, others.back());
    const auto fresh = makeSkin();
    fresh->setSkin(geometry, others.back());
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> other = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(other->pose(*fresh, *bones));
    ASSERT_TRUE(update->pose(*skin, *bones));
    EXPECT_EQ(positionsOf(*skin), positionsOf(*fresh));
    RecordProperty("modelsUntilThen", static_cast<int>(others.size()));
}
