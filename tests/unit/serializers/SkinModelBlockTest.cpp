// SPDX-License-Identifier: MIT
#include "serialize/SkinModelBlock.h"
#include "SlopedTube.h"
#include "SomeCorrectives.h"
#include "Tube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

using osgSkin::SkinModel;

namespace {

void expectEqual(const SkinModel& a, const SkinModel& b) {
    ASSERT_EQ(a.joints().size(), b.joints().size());
    for (std::size_t j = 0; j < a.joints().size(); ++j) {
        EXPECT_EQ(a.joints()[j].name, b.joints()[j].name);
        EXPECT_EQ(a.joints()[j].parent, b.joints()[j].parent);
        EXPECT_EQ(a.joints()[j].centre, b.joints()[j].centre);
        EXPECT_EQ(a.joints()[j].boneAxis, b.joints()[j].boneAxis);
        EXPECT_EQ(a.joints()[j].twistAxis, b.joints()[j].twistAxis);
    }
    EXPECT_EQ(a.positions(), b.positions());
    EXPECT_EQ(a.normals(), b.normals());
    EXPECT_EQ(a.order(), b.order());
    ASSERT_EQ(a.ratios().size(), b.ratios().size());
    for (std::size_t i = 0; i < a.ratios().size(); ++i) {
        EXPECT_EQ(a.ratios()[i].bend, b.ratios()[i].bend);
        EXPECT_EQ(a.ratios()[i].twist, b.ratios()[i].twist);
    }
    ASSERT_EQ(a.links().size(), b.links().size());
    for (std::size_t i = 0; i < a.links().size(); ++i) {
        EXPECT_EQ(a.links()[i].joint, b.links()[i].joint);
        EXPECT_EQ(a.links()[i].partial, b.links()[i].partial);
    }
}

} // namespace

TEST(SkinModelBlock, ModelRoundTrips) {
    test::Tube tube;
    tube.binding.joints[1].centre.x = 0.1; // not exact in single precision
    tube.binding.joints[1].name = "a name, 17 bytes";
    tube.binding.joints[2].name = "";
    const auto model = tube.model();
    expectEqual(*osgSkin::unpackSkinModel(osgSkin::packSkinModel(*model)), *model);
}

TEST(SkinModelBlock, GradientsRoundTrip) {
    for (const bool corrected : {false, true}) {
        test::SlopedTube tube(21, 7);
        if (corrected) tube.binding.correctives = test::someCorrectives(tube.binding, 0.3, 2, true);
        const auto model = tube.model();
        const std::vector<std::uint32_t> words = osgSkin::packSkinModel(*model);
        const auto again = osgSkin::unpackSkinModel(words);
        expectEqual(*again, *model);
        EXPECT_TRUE(again->hasSurfaceNormals());
        EXPECT_EQ(again->hasCorrectives(), corrected);
        EXPECT_EQ(osgSkin::packSkinModel(*again), words);
    }
}

TEST(SkinModelBlock, GradientsOfAnySteepnessRoundTrip) {
    std::mt19937_64 random(7);
    std::normal_distribution<float> number;
    for (int i = 0; i < 200; ++i) {
        test::SlopedTube tube(9, 7);
        const float spread = 0.02f * static_cast<float>(i); // from all equal to 1e7 times as steep
        for (osgSkin::RatioGradient& gradient : tube.binding.gradients)
            for (glm::vec3* of : {&gradient.bend, &gradient.twist})
                *of = std::exp(spread * number(random)) *
                      glm::vec3(number(random), number(random), number(random));
        const std::vector<std::uint32_t> words = osgSkin::packSkinModel(*tube.model());
        ASSERT_EQ(osgSkin::packSkinModel(*osgSkin::unpackSkinModel(words)), words) << spread;
    }
}

TEST(SkinModelBlock, CorrectivesRoundTrip) {
    for (const bool withNormals : {false, true}) {
        test::Tube tube;
        tube.binding.correctives = test::someCorrectives(tube.binding, 0.1, 2, withNormals);
        const auto model = tube.model();
        const std::vector<std::uint32_t> words = osgSkin::packSkinModel(*model);
        const auto back = osgSkin::unpackSkinModel(words);
        expectEqual(*back, *model);
        EXPECT_EQ(osgSkin::packSkinModel(*back), words);
        const osgSkin::Correctives& before = tube.binding.correctives;
        const osgSkin::Correctives after = back->correctives();
        EXPECT_EQ(after.inputs, before.inputs);
        EXPECT_EQ(after.shares, before.shares);
        EXPECT_EQ(after.normalShares, before.normalShares);
        EXPECT_EQ(after.firstEntry, before.firstEntry);
        ASSERT_EQ(after.joints.size(), before.joints.size());
        for (std::size_t j = 0; j < after.joints.size(); ++j) {
            EXPECT_EQ(after.joints[j].joint, before.joints[j].joint);
            EXPECT_EQ(after.joints[j].basis, before.joints[j].basis);
            EXPECT_EQ(after.joints[j].axis, before.joints[j].axis);
            EXPECT_EQ(after.joints[j].low, before.joints[j].low);
            EXPECT_EQ(after.joints[j].high, before.joints[j].high);
            EXPECT_EQ(after.joints[j].knots, before.joints[j].knots);
            EXPECT_EQ(after.joints[j].coefficients, before.joints[j].coefficients);
            EXPECT_EQ(after.joints[j].normalScales, before.joints[j].normalScales);
        }
    }
}

/// Older models have each leg as a whole in their product.
TEST(SkinModelBlock, ModelsOfTheFormerOrderKeepIt) {
    const glm::dvec3 down(0.0, -1.0, 0.0);
    const double above = 7.25, beside = -0.5;
    osgSkin::Binding legs;
    legs.joints = {{"hips", -1, {0.0, 0.0, 0.0}, down, down},
                   {"left", 0, {0.5, -0.5, 0.0}, down, down},
                   {"leftKnee", 1, {0.5, -2.0, 0.0}, down, down},
                   {"right", 0, {0.0, above, 0.0}, down, down}};
    legs.influences = {{0, 1.0f, 1.0f}, {1, 0.5f, 0.5f}, {2, 0.5f, 0.5f}, {3, 0.5f, 0.5f}};
    legs.regions = {0};
    legs.firstInfluence = {0, 4};
    const auto apart = SkinModel::create(legs, {{0.0f, -2.0f, 0.0f}}, {{0.0f, 0.0f, 1.0f}}, {0});
    std::vector<std::uint32_t> words = osgSkin::packSkinModel(*apart);
    std::uint32_t from[2], to[2];
    std::memcpy(from, &above, sizeof above);
    std::memcpy(to, &beside, sizeof beside);
    const auto place = std::search(words.begin(), words.end(), from, from + 2);
    ASSERT_NE(place, words.end());
    std::copy(to, to + 2, place);
    const auto again = osgSkin::unpackSkinModel(words);
    EXPECT_EQ(osgSkin::productOrder(again->joints()), (std::vector<std::uint32_t>{0, 1, 3, 2}));
    ASSERT_EQ(again->links().size(), 4u);
    for (std::uint32_t j = 0; j < 4; ++j) EXPECT_EQ(again->links()[j].joint, j);
    EXPECT_EQ(osgSkin::packSkinModel(*again), words);
}
