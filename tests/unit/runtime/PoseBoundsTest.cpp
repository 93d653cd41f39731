// SPDX-License-Identifier: MIT
//
// The boxes of posed skins contain every vertex, and are not much larger than necessary. The system
// test of loaded characters does the same with bodies in motion.
#include "SomeCorrectives.h"
#include "SomeMorphs.h"
#include "Tube.h"
#include "TubeSkin.h"
#include "Turns.h"

#include <osgSkin/Deform>
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/MorphTargets>
#include <osgSkin/Pose>
#include <osgSkin/PoseBounds>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

using osgSkin::JointMap;
using osgSkin::Pose;
using osgSkin::PoseBounds;
using osgSkin::SkinModel;

double volumeOf(const PoseBounds& box) {
    const glm::dvec3 size = box.high - box.low;
    return size.x * size.y * size.z;
}

/// Checks that a pose's box contains every vertex.
///
/// \return its volume relative to the tight box's
double looseness(const SkinModel& model, const Pose& pose) {
    PoseBounds tight{glm::vec3(std::numeric_limits<float>::max()),
                     glm::vec3(-std::numeric_limits<float>::max())};
    for (const glm::vec3& p : deform(model, pose).positions) {
        tight.low = glm::min(tight.low, p);
        tight.high = glm::max(tight.high, p);
    }
    const PoseBounds box = computePoseBounds(model, pose);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(box.low[axis], tight.low[axis]);
        EXPECT_GE(box.high[axis], tight.high[axis]);
    }
    return volumeOf(box) / volumeOf(tight);
}

/// How joints move in random poses.
struct Motion {
    const char* name;
    double angle;  ///< largest rotation, radians
    double scale;  ///< largest scale of a joint; the least is its inverse
    double travel; ///< largest translation of a joint along each axis
};

std::ostream& operator<<(std::ostream& out, const Motion& motion) {
    return out << motion.name;
}

const Motion kMotions[] = {
    {"Rotated", 3.1, 1.0, 0.0},
    {"Scaled", 1.5, 1.2, 0.0},
    {"ScaledByFour", 3.1, 4.0, 0.0},
    {"Translated", 1.5, 1.0, 1.0},
    {"RotatedScaledAndTranslated", 3.1, 2.0, 1.0},
};

/// \param i a number of the pose: the root is moved far with large ones
std::vector<JointMap> randomMaps(const SkinModel& model, const Motion& motion, int i,
                                 std::mt19937_64& random) {
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    std::vector<JointMap> own;
    for (const osgSkin::BoundJoint& joint : model.joints()) {
        JointMap map;
        map.rotation = glm::angleAxis(motion.angle * share(random), test::randomUnit(random));
        map.scale = std::pow(motion.scale, share(random));
        map.offset = joint.centre - map.scale * (map.rotation * joint.centre);
        if (joint.parent < 0) map.offset += glm::dvec3(i, 2 * i, -i);
        map.offset += motion.travel * glm::dvec3(share(random), share(random), share(random));
        own.push_back(map);
    }
    return own;
}

/// Every other pose continues the twists of the last one.
Pose::Twist twistOf(int i) {
    return i % 2 == 0 ? Pose::Twist::Shortest : Pose::Twist::Continued;
}

/// \return the mean looseness of random poses
double checkRandomPoses(const SkinModel& model, const Motion& motion) {
    constexpr int kPoses = 300;
    std::mt19937_64 random(6);
    std::uniform_real_distribution<float> input(-0.5f, 1.5f); // also out of range
    Pose pose(model.joints(), model.inputs().size());
    double sum = 0.0;
    for (int i = 0; i < kPoses && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE(i);
        const std::vector<JointMap> own = randomMaps(model, motion, i, random);
        EXPECT_TRUE(pose.set(own.data(), own.size(), twistOf(i)));
        for (std::size_t k = 0; k < model.inputs().size(); ++k)
            EXPECT_TRUE(pose.setInput(k, input(random)));
        sum += looseness(model, pose);
    }
    return sum / kPoses;
}

/// Legs that branch from a trunk: vertices follow both in part, above a knee and a foot.
osg::ref_ptr<const SkinModel> forkedModel(const char* rightName) {
    const glm::dvec3 down(0, -1, 0);
    osgSkin::Binding binding;
    binding.joints = {{"root", -1, {0, 0, 0}, down, down},
                      {"left", 0, {1, -1, 0}, down, down},
                      {"knee", 1, {1, -3, 0}, down, down},
                      {rightName, 0, {-0.5, -1, 0}, down, down}}; // beside the left one
    binding.firstInfluence.push_back(0);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<float> x(-2.0f, 2.0f), y(-4.0f, 1.0f);
    std::vector<glm::vec3> positions, normals;
    std::vector<std::uint32_t> source;
    const auto ratio = [](float r) { return std::min(1.0f, std::max(0.0f, r)); };
    for (std::uint32_t v = 0; v < 1500; ++v) {
        const glm::vec3 p(x(random), y(random), 0.3f * x(random));
        positions.push_back(p);
        normals.emplace_back(test::randomUnit(random));
        source.push_back(v);
        binding.influences.push_back({0, 1.0f, 1.0f});
        const float left = ratio(0.5f + 0.4f * p.x - 0.3f * p.y);
        const float right = ratio(0.4f - 0.5f * p.x - 0.2f * p.y);
        const float knee = ratio(-p.y - 2.5f), kneeTwist = ratio(-0.5f * p.y - 0.5f);
        if (left > 0.0f) binding.influences.push_back({1, left, ratio(1.3f * left)});
        if (knee > 0.0f || kneeTwist > 0.0f) binding.influences.push_back({2, knee, kneeTwist});
        if (right > 0.0f) binding.influences.push_back({3, right, right});
        binding.regions.push_back(0);
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    return SkinModel::create(binding, positions, normals, source);
}

class RandomPoseBounds : public testing::TestWithParam<Motion> {};

} // namespace

TEST_P(RandomPoseBounds, ContainVerticesOfATube) {
    checkRandomPoses(*test::Tube(61, 24).model(), GetParam());
}

TEST_P(RandomPoseBounds, ContainVerticesOfTwoBranches) {
    checkRandomPoses(*forkedModel("right"), GetParam());
}

/// The last branch of the file is the first one in the product.
TEST_P(RandomPoseBounds, ContainVerticesOfBranchesInAnotherOrder) {
    checkRandomPoses(*forkedModel("first"), GetParam());
}

TEST_P(RandomPoseBounds, ContainVerticesMovedByCorrectives) {
    test::Tube tube(41, 18);
    tube.binding.correctives = test::someCorrectives(tube.binding, 0.3, 41, true, 14);
    checkRandomPoses(*tube.model(), GetParam());
}

TEST_P(RandomPoseBounds, ContainVerticesMovedByMorphTargets) {
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    const SkinModel& model = *skin->getModel();
    skin->setMorphTargets(osgSkin::MorphTargets::create(test::someMorphs(model.vertexCount(), 0.5),
                                                        model.vertexCount()));
    std::mt19937_64 random(7);
    std::uniform_real_distribution<float> weight(-1.5f, 1.5f);
    for (int i = 0; i < 300; ++i) {
        const std::vector<JointMap> own = randomMaps(model, GetParam(), i, random);
        ASSERT_TRUE(skin->setPose(own.data(), own.size(), twistOf(i)));
        ASSERT_TRUE(skin->setMorphWeights({weight(random), weight(random), weight(random)}));
        const osg::BoundingBox box = skin->getBoundingBox();
        for (const osg::Vec3& p :
             static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray()))
            ASSERT_TRUE(box.contains(p)) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Motions, RandomPoseBounds, testing::ValuesIn(kMotions),
                         [](const auto& motion) { return std::string(motion.param.name); });

TEST(PoseBounds, StayCloseToTheSkin) {
    const auto model = test::Tube(61, 24).model();
    EXPECT_LE(checkRandomPoses(*model, {"Natural", 1.5, 1.0, 0.0}), 2.2);
    EXPECT_LE(checkRandomPoses(*model, {"Scaled", 1.5, 1.2, 0.0}), 2.2);
}

TEST(PoseBounds, RestPoseHasTheTightBox) {
    const auto model = test::Tube(61, 24).model();
    EXPECT_LE(looseness(*model, Pose(model->joints())), 1.01);
}

/// Thousands of joints below a long chain, one per vertex: each vertex's own joint must be found
/// without searching all others again and again.
TEST(PoseBounds, AreMadeOfManyJointsInSeconds) {
    constexpr std::uint32_t kChain = 900, kLeaves = 4'000;
    osgSkin::Binding binding;
    for (std::uint32_t j = 0; j < kChain + kLeaves; ++j) {
        osgSkin::BoundJoint joint;
        joint.name = std::to_string(j);
        joint.parent = static_cast<int>(std::min(j, kChain)) - 1;
        joint.boneAxis = joint.twistAxis = {0.0, 1.0, 0.0};
        binding.joints.push_back(joint);
    }
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> source;
    binding.firstInfluence = {0};
    for (std::uint32_t v = 0; v < kLeaves; ++v) {
        for (std::uint32_t j = 0; j < kChain; ++j) binding.influences.push_back({j, 1.0f, 1.0f});
        binding.influences.push_back({kChain + v, 1.0f, 1.0f});
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
        source.push_back(v);
        positions.emplace_back(v % 7, static_cast<float>(v) / 500.0f, v % 5);
    }
    binding.regions.assign(positions.size(), 0);
    const std::vector<glm::vec3> normals(positions.size(), glm::vec3(0, 1, 0));
    const std::clock_t begin = std::clock();
    const auto model = SkinModel::create(binding, positions, normals, source);
    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    EXPECT_LE(looseness(*model, Pose(model->joints())), 1.01);
#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG) // also slow at counting lines
    constexpr double kMaxSeconds = 40.0;
#else
    constexpr double kMaxSeconds = 8.0;
#endif
    EXPECT_LT(seconds, kMaxSeconds) << "of this program's own";
}

/// A small file could otherwise ask for much memory.
TEST(PoseBounds, RefusesVertexThatFollowsManyBranches) {
    test::Tube tube(2, 1);
    osgSkin::BoundJoint joint = tube.binding.joints.front();
    joint.parent = 0;
    tube.binding.influences.clear();
    tube.binding.firstInfluence = {0};
    for (std::uint32_t j = 0; j < 2000; ++j) {
        joint.name = std::to_string(j);
        if (j >= tube.binding.joints.size()) tube.binding.joints.push_back(joint);
    }
    for (std::size_t v = 0; v < tube.positions.size(); ++v) {
        for (std::uint32_t j = 0; j < 2000; ++j) tube.binding.influences.push_back({j, 1.0f, 1.0f});
        tube.binding.firstInfluence.push_back(
            static_cast<std::uint32_t>(tube.binding.influences.size()));
    }
    EXPECT_THROW(tube.model(), osgSkin::Error);
}
