// SPDX-License-Identifier: MIT
//
// The pose in which a skin was saved: it is visible until the bones move.
#include "SavedScene.h"
#include "Turns.h"

#include <gtest/gtest.h>
#include <osg/Notify>

#include <limits>
#include <ostream>
#include <random>

namespace {

using osgSkin::DeformableSkin;

constexpr double kScales[] = {1.5, 0.8, 2.0}; ///< of root, middle and end, relative to the parent

/// Every joint rotated and scaled about its centre.
std::vector<glm::dmat4> scaledPose(const osgSkin::SkinModel& model) {
    std::mt19937_64 random(11);
    std::vector<glm::dmat4> skinning;
    for (std::size_t j = 0; j < model.joints().size(); ++j) {
        const osgSkin::BoundJoint& joint = model.joints()[j];
        const glm::dmat4 own = glm::translate(glm::dmat4(1.0), joint.centre) *
                               glm::mat4_cast(test::randomRotation(random)) *
                               glm::scale(glm::dmat4(1.0), glm::dvec3(kScales[j])) *
                               glm::translate(glm::dmat4(1.0), -joint.centre);
        skinning.push_back(j == 0 ? own : skinning.back() * own);
    }
    return skinning;
}

class SavedPose : public test::Quietly<const char*> {
protected:
    osg::ref_ptr<osg::Group> scene = test::makeScene();
    DeformableSkin& skin = *test::skinsOf(*scene)[0];
};

const osg::Vec3Array& skinVertices(const DeformableSkin& skin) {
    return static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray());
}

} // namespace

TEST_P(SavedPose, KeepsScale) {
    const std::vector<glm::dmat4> skinning = scaledPose(*skin.getModel());
    ASSERT_TRUE(skin.setPose(skinning.data(), skinning.size()));
    for (std::size_t j = 0; j < 3; ++j)
        ASSERT_NEAR(skin.getPose().transform(j).scale, kScales[j], 1e-9);

    const osg::ref_ptr<osg::Node> after = test::load(test::save(*scene, GetParam()), GetParam());
    ASSERT_NE(after, nullptr);
    const DeformableSkin& is = *test::skinsOf(*after)[0];
    for (std::size_t j = 0; j < 3; ++j)
        EXPECT_NEAR(is.getPose().transform(j).scale, kScales[j], 1e-9) << j;
    const osg::Vec3Array& a = skinVertices(skin);
    const osg::Vec3Array& b = skinVertices(is);
    ASSERT_EQ(b.size(), a.size());
    for (std::size_t v = 0; v < a.size(); ++v) ASSERT_LE((a[v] - b[v]).length(), 2e-5f) << v;
}

/// Every pose that a skin accepts is restored: a bone may be scaled down until it is invisible.
TEST_P(SavedPose, KeepsExtremeScales) {
    for (const double scale : {2e-9, 1e-7, 1e7, 5e8}) {
        const std::vector<glm::dmat4> skinning = {
            glm::dmat4(1.0), glm::scale(glm::dmat4(1.0), glm::dvec3(scale)), glm::dmat4(1.0)};
        ASSERT_TRUE(skin.setPose(skinning.data(), skinning.size())) << scale;
        const osg::ref_ptr<osg::Node> after =
            test::load(test::save(*scene, GetParam()), GetParam());
        ASSERT_NE(after, nullptr) << scale;
        EXPECT_NEAR(test::skinsOf(*after)[0]->getPose().transform(1).scale / scale, 1.0, 1e-6);
    }
}

TEST_P(SavedPose, CopyKeepsItsOwnPose) {
    const std::vector<glm::dmat4> skinning = scaledPose(*skin.getModel());
    ASSERT_TRUE(skin.setPose(skinning.data(), skinning.size()));
    const osg::ref_ptr<osg::Node> after = test::load(test::save(*scene, GetParam()), GetParam());
    ASSERT_NE(after, nullptr);
    const DeformableSkin& rest = *test::skinsOf(*after)[1];
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(rest.getPose().transform(j).scale, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Formats, SavedPose, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& format) { return std::string(format.param); });

namespace {

glm::dmat4 scaling(double x, double y, double z) {
    return glm::scale(glm::dmat4(1.0), glm::dvec3(x, y, z));
}

std::string bytesOf(const glm::dmat4& matrix) {
    return {reinterpret_cast<const char*>(&matrix), sizeof matrix};
}

/// A binary file of a skin whose middle joint has this skinning matrix.
std::string fileWith(const glm::dmat4& middle) {
    const osg::ref_ptr<osg::Group> scene = test::makeScene();
    DeformableSkin& skin = *test::skinsOf(*scene)[0];
    const std::vector<glm::dmat4> skinning = {scaling(1, 1, 1), scaling(4, 4, 4), scaling(1, 1, 1)};
    EXPECT_TRUE(skin.setPose(skinning.data(), skinning.size()));
    std::string file = test::save(*scene, "osgb");
    const std::size_t place = file.find(bytesOf(skinning[1]));
    EXPECT_NE(place, std::string::npos);
    return file.replace(place, sizeof middle, bytesOf(middle));
}

constexpr double kNotFinite = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct BadPose {
    const char* name;
    glm::dmat4 matrix;
    const char* reason;
};

void PrintTo(const BadPose& bad, std::ostream* out) {
    *out << bad.name;
}

class HostilePose : public test::Quietly<BadPose> {};

} // namespace

TEST_P(HostilePose, IsRefusedWithItsReason) {
    std::string reason;
    EXPECT_EQ(test::load(fileWith(GetParam().matrix), "osgb", &reason), nullptr);
    EXPECT_NE(reason.find("joint \"middle\""), std::string::npos) << reason;
    EXPECT_NE(reason.find(GetParam().reason), std::string::npos) << reason;
}

INSTANTIATE_TEST_SUITE_P(
    Matrices, HostilePose,
    testing::Values(BadPose{"ScaleOfNothing", scaling(0, 0, 0), "singular"},
                    BadPose{"Flat", scaling(1, 1, 0), "singular"},
                    BadPose{"NotANumber", scaling(kNotFinite, 1, 1), "not finite"},
                    BadPose{"Infinite", scaling(1, kInfinite, 1), "not finite"},
                    BadPose{"Huge", scaling(1e30, 1e30, 1e30), "too large"},
                    BadPose{"Large", scaling(1e10, 1e10, 1e10), "scale of 1e+10"},
                    BadPose{"Small", scaling(1e-10, 1e-10, 1e-10), "scale of 1e-10"}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST(SavedPoseFile, UnalteredIsRead) {
    const osg::ref_ptr<osg::Node> node = test::load(fileWith(scaling(4, 4, 4)), "osgb");
    ASSERT_NE(node, nullptr);
    EXPECT_DOUBLE_EQ(test::skinsOf(*node)[0]->getPose().transform(1).scale, 4.0);
}
