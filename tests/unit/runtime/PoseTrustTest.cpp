// SPDX-License-Identifier: MIT
// Poses that cannot be followed, and those that may not be told apart.
#include <osgSkin/DeformableSkin>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>

#include "Notices.h"
#include "TubeSkin.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

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

/// What cannot be followed is refused, and the last good pose stays; what can is finite.
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

/// The same where a pose comes without matrices, joint by joint.
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
        {{map(0.0, 1e7), map(0.0, 1e7), map(0.0, 1e7)}, false}, // together only, as the next
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

/// A vertex follows several joints by shares: what each of them may do, all may not together.
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

/// Memory is given out again: a new model may stand where another one stood.
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
