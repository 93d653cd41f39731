// SPDX-License-Identifier: MIT
//
// A skin model's block is untrusted: refused with a reason, never a crash.
#include "SlopedTube.h"
#include "SomeCorrectives.h"
#include "Tube.h"
#include "serialize/AnimationBlock.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/Error>
#include <osgSkin/Pose>
#include <osgSkin/PoseBounds>

#include <gtest/gtest.h>
#include <osgAnimation/Channel>

#include <functional>
#include <limits>
#include <ostream>
#include <random>

namespace {

using Words = std::vector<std::uint32_t>;

// Offsets in the tube's block: joint 0 is "root", whose name takes one word.
constexpr std::size_t kParent = 1, kNameSize = 2, kCentre = 4, kBoneAxis = 10;
constexpr std::uint32_t kNan = 0x7fc00000u;
constexpr std::uint32_t kTwo = 0x40000000u;  // 2.0f
constexpr std::uint32_t kHuge = 0x7f7fffffu; // 3.4e38f
constexpr std::uint32_t kThousand = 0x447a0000u;

void expectRefused(const Words& words, const std::string& reason) {
    try {
        osgSkin::unpackSkinModel(words);
        FAIL() << "accepted";
    } catch (const osgSkin::Error& error) {
        EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
}

/// Offsets in a block.
struct Places {
    explicit Places(const osgSkin::SkinModel& model, const Words& words)
        : vertices(1 + 20 + 1 + 20 + 2 + 20 + 1), // "root", "middle", "end"
          order(vertices + 1 + 6 * model.vertexCount()), groups(order + model.vertexCount()),
          parts(groups + 1) {
        for (const osgSkin::SkinModel::Group& group : model.groups()) parts += 2 + group.linkCount;
        ratios = parts;
        parts += 1 + 2 * model.ratios().size();
        EXPECT_EQ(words[vertices], model.vertexCount());
        EXPECT_EQ(words[groups], model.groups().size());
    }
    std::size_t vertices, order, groups, ratios = 0, parts;
};

struct BadBlock {
    const char* name;
    const char* reason;
    std::function<void(Words&, const Places&)> spoil;
};
std::ostream& operator<<(std::ostream& out, const BadBlock& bad) {
    return out << bad.name;
}

const std::vector<BadBlock> kBadBlocks = {
    {"Empty", "ends too early", [](Words& w, const Places&) { w.clear(); }},
    {"NoJoint", "", [](Words& w, const Places&) { w[0] = 0; }},
    {"ManyJoints", "joints have no room", [](Words& w, const Places&) { w[0] = 0xffffffffu; }},
    {"Cycle", "after its parent", [](Words& w, const Places&) { w[kParent] = 1; }},
    {"LongName", "name has no room", [](Words& w, const Places&) { w[kNameSize] = 0xfffffff0u; }},
    {"CentreNan", "centre that is not finite",
     [](Words& w, const Places&) { w[kCentre + 1] = 0x7ff80000u; }},
    {"AxisNotUnit", "not a unit vector",
     [](Words& w, const Places&) { w[kBoneAxis + 3] = 0x40000000u; }},
    {"NoVertex", "no vertex",
     [](Words& w, const Places& at) {
         w.resize(at.vertices + 1);
         w.back() = 0;
     }},
    {"PositionHuge", "position that is not finite, or beyond",
     [](Words& w, const Places& at) { w[at.vertices + 1] = kHuge; }},
    {"NormalInfinite", "normal that is not finite",
     [](Words& w, const Places& at) { w[at.order - 1] = 0x7f800000u; }},
    {"NormalLong", "normal that is not finite, or longer than 10",
     [](Words& w, const Places& at) { w[at.order - 1] = kThousand; }},
    {"ManyVertices", "vertices have no room",
     [](Words& w, const Places& at) { w[at.vertices] = 0x80000000u; }},
    {"PositionNan", "position that is not finite",
     [](Words& w, const Places& at) { w[at.vertices + 1] = kNan; }},
    {"OrderTwice", "order is not that of its vertices",
     [](Words& w, const Places& at) { w[at.order] = w[at.order + 1]; }},
    {"OrderBeyond", "order is not that of its vertices",
     [](Words& w, const Places& at) { w[at.order] = 0xffffffffu; }},
    {"ManyGroups", "groups have no room",
     [](Words& w, const Places& at) { w[at.groups] = 0x70000000u; }},
    {"EmptyGroup", "groups do not fit", [](Words& w, const Places& at) { w[at.groups + 1] = 0; }},
    {"LongGroup", "groups do not fit",
     [](Words& w, const Places& at) { w[at.groups + 1] = 0xffffffffu; }},
    {"NoRoot", "does not follow the root",
     [](Words& w, const Places& at) { w[at.groups + 3] = 1; }},
    {"PartialRoot", "does not follow the root",
     [](Words& w, const Places& at) { w[at.groups + 3] = 0x80000000u; }},
    {"ManyRatios", "ratios have no room",
     [](Words& w, const Places& at) { w[at.ratios] = 0x70000000u; }},
    {"RatioAboveOne", "outside [0, 1]",
     [](Words& w, const Places& at) { w[at.ratios + 1] = kTwo; }},
    {"RatioNan", "outside [0, 1]", [](Words& w, const Places& at) { w[at.ratios + 2] = kNan; }},
    {"UnknownSection", "unknown section", [](Words& w, const Places& at) { w[at.parts] |= 4; }},
    {"GradientUnit", "gradient is not finite",
     [](Words& w, const Places& at) { w[at.parts + 2] = 0x7ff00000u; }},
    {"GradientAcross", "gradient is not finite",
     [](Words& w, const Places& at) { w[at.parts + 3] = kNan; }},
    {"CutShort", "", [](Words& w, const Places&) { w.pop_back(); }},
    {"TooLong", "more in it", [](Words& w, const Places&) { w.push_back(0); }},
};

class HostileBlock : public testing::TestWithParam<BadBlock> {};

} // namespace

TEST_P(HostileBlock, IsRefused) {
    test::SlopedTube tube(21, 7);
    tube.binding.correctives = test::someCorrectives(tube.binding, 0.3, 2, true);
    const auto model = tube.model();
    Words words = osgSkin::packSkinModel(*model);
    GetParam().spoil(words, Places(*model, words));
    expectRefused(words, GetParam().reason);
}

INSTANTIATE_TEST_SUITE_P(Blocks, HostileBlock, testing::ValuesIn(kBadBlocks),
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
        for (int change = 0; change < 1 + round % 4; ++change)
            words[random() % words.size()] =
                random() % 2 ? extreme[random() % 7] : static_cast<std::uint32_t>(random());
        if (round % 5 == 0) words.resize(random() % words.size());
        try {
            const auto model = osgSkin::unpackSkinModel(words);
            osgSkin::computePoseBounds(*model, osgSkin::Pose(model->joints()));
        } catch (const osgSkin::Error&) { // the expected exception
        }
    }
}

/// Packs a clip with one key.
template <typename Channel, typename Value>
Words clipOf(const Value& value) {
    const osg::ref_ptr<Channel> channel = new Channel;
    channel->getOrCreateSampler()->getOrCreateKeyframeContainer()->push_back({0.0, value});
    const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    animation->addChannel(channel);
    return osgSkin::packAnimations({animation});
}

TEST(HostileAnimation, KeysOutOfRangeAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const float infinite = std::numeric_limits<float>::infinity();
    using Turns = osgAnimation::QuatSphericalLinearChannel;
    using Places = osgAnimation::Vec3LinearChannel;
    for (const Words& words :
         {clipOf<Turns>(osg::Quat(0, nan, 0, 1)), clipOf<Places>(osg::Vec3(0, 0, -1e19f)),
          clipOf<osgAnimation::FloatLinearChannel>(infinite),
          clipOf<osgAnimation::DoubleLinearChannel>(1e300)})
        try {
            osgSkin::unpackAnimations(words);
            ADD_FAILURE() << "accepted";
        } catch (const osgSkin::Error& error) {
            EXPECT_NE(std::string(error.what()).find("a key's value is not finite, or beyond"),
                      std::string::npos)
                << error.what();
        }
    EXPECT_EQ(osgSkin::unpackAnimations(clipOf<Places>(osg::Vec3(0, 0, -9e17f))).size(), 1u);
}
