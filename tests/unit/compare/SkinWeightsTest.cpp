// SPDX-License-Identifier: MIT
#include "Blending.h"

#include <gtest/gtest.h>

#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

using namespace compare;

namespace {

TEST(SkinWeights, DefaultHasNoVertex) {
    const SkinWeights weights;
    EXPECT_EQ(weights.vertexCount(), 0u);
    EXPECT_NO_THROW(weights.validate(0));
}

TEST(SkinWeights, AddSkipsZeroWeights) {
    SkinWeights weights;
    weights.add({{0, 0.0}, {3, 1.0}});
    ASSERT_EQ(weights.entries.size(), 1u);
    EXPECT_EQ(weights.entries[0].joint, 3u);
    EXPECT_NO_THROW(weights.validate(4));
}

struct BadCase {
    std::string name;
    SkinWeights weights;
};

std::ostream& operator<<(std::ostream& out, const BadCase& bad) {
    return out << bad.name;
}

class BadSkinWeights : public testing::TestWithParam<BadCase> {};

TEST_P(BadSkinWeights, AreRejected) {
    EXPECT_THROW(GetParam().weights.validate(2), std::invalid_argument);
}

const BadCase kBadCases[] = {
    {"NoOffsets", {{}, {}}},
    {"FirstOffsetNotZero", {{1, 1}, {{0, 1.0}}}},
    {"OffsetsPastTheEnd", {{0, 2, 1}, {{0, 1.0}}}},
    {"OffsetsDecrease", {{0, 2, 1, 2}, {{0, 0.5}, {1, 0.5}}}},
    {"EntriesLeftOver", {{0, 1}, {{0, 1.0}, {1, 1.0}}}},
    {"VertexWithoutWeights", {{0, 0}, {}}},
    {"NoSuchJoint", {{0, 1}, {{2, 1.0}}}},
    {"Negative", {{0, 2}, {{0, -0.5}, {1, 1.5}}}},
    {"NotANumber", {{0, 1}, {{0, std::numeric_limits<double>::quiet_NaN()}}}},
    {"SumTooSmall", {{0, 2}, {{0, 0.5}, {1, 0.4}}}},
};

INSTANTIATE_TEST_SUITE_P(SkinWeights, BadSkinWeights, testing::ValuesIn(kBadCases),
                         [](const auto& tested) { return tested.param.name; });

} // namespace
