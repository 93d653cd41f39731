// SPDX-License-Identifier: MIT
#include "Tube.h"

#include <osgSkin/Error>
#include <osgSkin/SkinTangents>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

using namespace osgSkin;

TEST(SkinModel, RejectsMismatchedArraysAndInvalidRatios) {
    const test::Tube tube(3, 3);
    using osgSkin::SkinModel;
    auto shortNormals = tube.normals;
    shortNormals.pop_back();
    EXPECT_THROW(SkinModel::create(tube.binding, tube.positions, shortNormals, tube.source),
                 osgSkin::Error);
    auto badSource = tube.source;
    badSource[0] = 1000;
    EXPECT_THROW(SkinModel::create(tube.binding, tube.positions, tube.normals, badSource),
                 osgSkin::Error);
    osgSkin::Binding badRatio = tube.binding;
    badRatio.influences.back().bend = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(SkinModel::create(badRatio, tube.positions, tube.normals, tube.source),
                 osgSkin::Error);
}

TEST(SkinModel, GroupsContainEachVertexOnce) {
    const test::Tube tube;
    const auto model = tube.model();
    std::vector<int> seen(tube.positions.size(), 0);
    for (const std::uint32_t v : model->order()) ++seen[v];
    EXPECT_EQ(seen, std::vector<int>(tube.positions.size(), 1));
    std::size_t vertices = 0;
    for (const auto& group : model->groups()) vertices += group.vertexCount;
    EXPECT_EQ(vertices, tube.positions.size());
}

TEST(SkinTangents, RejectMismatchedAndNonFiniteArrays) {
    const test::Tube tube(3, 3);
    const auto model = tube.model();
    const std::vector<glm::vec4> good(tube.positions.size(), glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(osgSkin::SkinTangents::create(model, good)->tangents(), good);
    EXPECT_THROW(osgSkin::SkinTangents::create(nullptr, good), osgSkin::Error);
    EXPECT_THROW(osgSkin::SkinTangents::create(model, {}), osgSkin::Error);
    std::vector<glm::vec4> spoilt = good;
    spoilt.back().y = std::numeric_limits<float>::infinity();
    EXPECT_THROW(osgSkin::SkinTangents::create(model, spoilt), osgSkin::Error);
}

namespace {

/// A tube whose vertices are in the worst order: those of a ring are far apart.
test::Tube shuffled() {
    test::Tube tube;
    const std::size_t count = tube.positions.size();
    const test::Tube straight = tube;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = i * 7 % count; // coprime
        tube.positions[i] = straight.positions[from];
        tube.normals[i] = straight.normals[from];
        tube.source[i] = straight.source[from];
    }
    return tube;
}

} // namespace

TEST(VertexOrder, ModelsCreatedInBestOrderHaveIt) {
    const test::Tube tube = shuffled();
    const auto made =
        SkinModel::createInBestOrder(tube.binding, tube.positions, tube.normals, tube.source);
    ASSERT_EQ(made.order, SkinModel::bestOrder(tube.binding, tube.source));
    std::vector<std::uint32_t> all = made.order;
    EXPECT_FALSE(std::is_sorted(all.begin(), all.end()));
    std::sort(all.begin(), all.end());
    for (std::uint32_t v = 0; v < all.size(); ++v) ASSERT_EQ(all[v], v) << "not each vertex once";

    const auto given = SkinModel::create(tube.binding, tube.positions, tube.normals, tube.source);
    ASSERT_EQ(made.model->groups().size(), given->groups().size());
    EXPECT_GT(made.model->groups().size(), 3u);
    ASSERT_EQ(made.model->ratios().size(), given->ratios().size());
    for (std::size_t r = 0; r < given->ratios().size(); ++r) {
        EXPECT_EQ(made.model->ratios()[r].bend, given->ratios()[r].bend);
        EXPECT_EQ(made.model->ratios()[r].twist, given->ratios()[r].twist);
    }
    for (std::uint32_t v = 0; v < made.order.size(); ++v) {
        EXPECT_EQ(made.model->order()[v], v) << "a vertex is written astray";
        EXPECT_EQ(given->order()[v], made.order[v]);
        EXPECT_EQ(made.model->positions()[v], tube.positions[made.order[v]]);
        EXPECT_EQ(made.model->normals()[v], tube.normals[made.order[v]]);
    }
}

TEST(VertexOrder, MergesSmallGroupsByRatiosOfZeroAndOne) {
    const test::Tube tube(25, 3);
    std::set<std::vector<std::uint32_t>> signatures;
    for (const std::uint32_t v : tube.source) {
        std::vector<std::uint32_t> signature;
        for (std::uint32_t i = tube.binding.firstInfluence[v];
             i < tube.binding.firstInfluence[v + 1]; ++i)
            signature.push_back(2 * tube.binding.influences[i].joint +
                                (tube.binding.influences[i].isPartial() ? 1 : 0));
        signatures.insert(signature);
    }
    const auto model = tube.model();
    EXPECT_LT(model->groups().size(), signatures.size());
    std::size_t seen = 0;
    for (const SkinModel::Group& group : model->groups()) {
        const SkinModel::Ratio* ratio = model->ratios().data() + group.firstRatio;
        for (std::uint32_t row = 0; row < group.vertexCount; ++row, ++seen) {
            const std::uint32_t bound = tube.source[model->order()[group.firstVertex + row]];
            std::vector<Influence> has; // in the model
            for (std::uint32_t k = 0; k < group.linkCount; ++k) {
                const SkinModel::Link& link = model->links()[group.firstLink + k];
                const SkinModel::Ratio own = link.partial ? *ratio++ : SkinModel::Ratio{1.0f, 1.0f};
                if (own.bend != 0.0f || own.twist != 0.0f)
                    has.push_back({link.joint, own.bend, own.twist});
            }
            const std::uint32_t first = tube.binding.firstInfluence[bound];
            ASSERT_EQ(has.size(), tube.binding.firstInfluence[bound + 1] - first);
            for (std::size_t i = 0; i < has.size(); ++i) {
                EXPECT_EQ(has[i].joint, tube.binding.influences[first + i].joint);
                EXPECT_EQ(has[i].bend, tube.binding.influences[first + i].bend);
                EXPECT_EQ(has[i].twist, tube.binding.influences[first + i].twist);
            }
        }
    }
    EXPECT_EQ(seen, tube.source.size());
}

/// As painted weights may be: hardly any two of 30,000 vertices follow the same three of 60 joints.
TEST(VertexOrder, GroupsManySignaturesQuickly) {
    constexpr std::uint32_t kJoints = 60;
    Binding binding;
    for (std::uint32_t j = 0; j < kJoints; ++j) {
        BoundJoint joint;
        joint.name = std::to_string(j);
        joint.parent = j == 0 ? -1 : 0;
        joint.boneAxis = joint.twistAxis = {0.0, 1.0, 0.0};
        binding.joints.push_back(joint);
    }
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> source;
    binding.firstInfluence = {0};
    for (std::uint32_t a = 1; a < kJoints; ++a)
        for (std::uint32_t b = a + 1; b < kJoints; ++b)
            for (std::uint32_t c = b + 1; c < kJoints; ++c) {
                binding.influences.push_back({0, 1.0f, 1.0f});
                for (const std::uint32_t joint : {a, b, c})
                    binding.influences.push_back({joint, 0.3f, 0.3f});
                binding.firstInfluence.push_back(
                    static_cast<std::uint32_t>(binding.influences.size()));
                source.push_back(static_cast<std::uint32_t>(positions.size()));
                positions.emplace_back(0.0f);
            }
    binding.regions.assign(positions.size(), 0);
    const std::vector<glm::vec3> normals(positions.size(), glm::vec3(0, 1, 0));
    const auto model = SkinModel::create(binding, positions, normals, source);
    EXPECT_EQ(model->vertexCount(), positions.size());
    EXPECT_LT(model->groups().size(), positions.size() / 2);
}

TEST(VertexOrder, RejectsInvalidArrays) {
    test::Tube tube;
    tube.normals.pop_back();
    EXPECT_THROW(
        SkinModel::createInBestOrder(tube.binding, tube.positions, tube.normals, tube.source),
        Error);
    tube = test::Tube();
    tube.source.back() = static_cast<std::uint32_t>(tube.binding.vertexCount());
    EXPECT_THROW(
        SkinModel::createInBestOrder(tube.binding, tube.positions, tube.normals, tube.source),
        Error);
}
