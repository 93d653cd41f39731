// SPDX-License-Identifier: MIT
// What a skin model's block says is not to be believed: refused with a reason, never a crash.
#include "SlopedTube.h"
#include "SomeCorrectives.h"
#include "Tube.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/Error>

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <random>

namespace {

using Words = std::vector<std::uint32_t>;

// Where things stand in the tube's block: joint 0 is "root", one word of name.
constexpr std::size_t kJoints = 1, kParent = 2, kNameSize = 3, kCentre = 5, kBoneAxis = 11;
constexpr std::uint32_t kNan = 0x7fc00000u;
constexpr std::uint32_t kTwo = 0x40000000u;  // 2.0f
constexpr std::uint32_t kHuge = 0x7f7fffffu; // 3.4e38f
constexpr std::uint32_t kThousand = 0x447a0000u;

std::size_t vertexCountAt() {
    return 2 + 20 + 1 + 20 + 2 + 20 + 1; // "root", "middle", "end"
}
std::size_t influencesAt(const Words& words) {
    return vertexCountAt() + 1 + std::size_t{6} * words[vertexCountAt()];
}

struct BadBlock {
    const char* name;
    const char* reason;
    std::function<void(Words&)> spoil;
};
std::ostream& operator<<(std::ostream& out, const BadBlock& bad) {
    return out << bad.name;
}

const std::vector<BadBlock> kBad = {
    {"Empty", "ends too early", [](Words& w) { w.clear(); }},
    {"Version", "version 4", [](Words& w) { w[0] = 4; }},
    {"VersionNought", "version 0", [](Words& w) { w[0] = 0; }},
    {"NoCorrectives", "ends too early", [](Words& w) { w[0] = 2; }},
    {"NoGradients", "ends too early", [](Words& w) { w[0] = 3; }},
    {"NoJoint", "", [](Words& w) { w[kJoints] = 0; }},
    {"ManyJoints", "joints have no room", [](Words& w) { w[kJoints] = 0xffffffffu; }},
    {"Cycle", "after its parent", [](Words& w) { w[kParent] = 1; }},
    {"LongName", "name has no room", [](Words& w) { w[kNameSize] = 0xfffffff0u; }},
    {"CentreNan", "centre that is not finite", [](Words& w) { w[kCentre + 1] = 0x7ff80000u; }},
    {"AxisNotUnit", "not a unit vector", [](Words& w) { w[kBoneAxis + 3] = 0x40000000u; }},
    {"ManyVertices", "vertices have no room", [](Words& w) { w[vertexCountAt()] = 0x80000000u; }},
    {"NoVertex", "no vertex",
     [](Words& w) {
         w.resize(vertexCountAt() + 1);
         w.back() = 0;
     }},
    {"PositionNan", "position that is not finite", [](Words& w) { w[vertexCountAt() + 1] = kNan; }},
    {"NormalInfinite", "normal that is not finite",
     [](Words& w) { w[influencesAt(w) - 1] = 0x7f800000u; }},
    {"PositionHuge", "position that is not finite, or beyond",
     [](Words& w) { w[vertexCountAt() + 1] = kHuge; }},
    {"NormalLong", "normal that is not finite, or longer than 10",
     [](Words& w) { w[influencesAt(w) - 1] = kThousand; }},
    {"NoInfluence", "", [](Words& w) { w[influencesAt(w)] = 0; }},
    {"ManyInfluences", "influences have no room",
     [](Words& w) { w[influencesAt(w)] = 0x55555556u; }},
    {"InfluenceOfNoJoint", "does not follow the root",
     [](Words& w) { w[influencesAt(w) + 1] = 99; }},
    {"RatioAboveOne", "root with ratio 1", [](Words& w) { w[influencesAt(w) + 2] = kTwo; }},
    {"RatioNan", "root with ratio 1", [](Words& w) { w[influencesAt(w) + 3] = kNan; }},
    {"CutShort", "no room in it", [](Words& w) { w.pop_back(); }},
    {"TooLong", "more in it", [](Words& w) { w.push_back(0); }},
};

class HostileBlock : public testing::TestWithParam<BadBlock> {};

} // namespace

TEST_P(HostileBlock, IsRefused) {
    Words words = osgSkin::packSkinModel(*test::Tube().model());
    GetParam().spoil(words);
    try {
        osgSkin::unpackSkinModel(words);
        FAIL() << "accepted";
    } catch (const osgSkin::Error& error) {
        EXPECT_NE(std::string(error.what()).find(GetParam().reason), std::string::npos)
            << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Blocks, HostileBlock, testing::ValuesIn(kBad),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(HostileBlockAtRandom, NeverCrashes) {
    std::mt19937 random(1);
    test::Tube tube(5, 6);
    const Words plain = osgSkin::packSkinModel(*tube.model());
    tube.binding.correctives = test::someCorrectives(tube.binding, 0.1, 1, true);
    const Words corrected = osgSkin::packSkinModel(*tube.model());
    test::SlopedTube slopedTube(5, 6);
    slopedTube.binding.correctives = tube.binding.correctives;
    const Words sloped = osgSkin::packSkinModel(*slopedTube.model());
    const std::uint32_t extreme[] = {0, 1, 0x7fffffffu, 0x80000000u, 0xffffffffu, kNan, kTwo};
    for (int round = 0; round < 20000; ++round) {
        Words words = round % 3 == 0 ? plain : round % 3 == 1 ? corrected : sloped;
        for (int change = 0; change < 1 + round % 3; ++change)
            words[random() % words.size()] =
                random() % 2 ? extreme[random() % 7] : static_cast<std::uint32_t>(random());
        if (round % 5 == 0) words.resize(random() % words.size());
        try {
            osgSkin::unpackSkinModel(words);
        } catch (const osgSkin::Error&) { // as it should be
        }
    }
}
