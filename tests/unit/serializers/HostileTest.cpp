// SPDX-License-Identifier: MIT
//
// A skin model's block is untrusted: refused with a reason, never a crash.
//
// Files truncated or altered within our own classes: no crash, and no incomplete character.
#include "SavedScene.h"
#include "SlopedTube.h"
#include "SomeCorrectives.h"
#include "Tube.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/Error>
#include <osgSkin/Pose>
#include <osgSkin/PoseBounds>

#include <gtest/gtest.h>
#include <osg/Notify>

#include <algorithm>
#include <functional>
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

namespace {

/// Besides our own messages, OSG prints its reading of each word of a bad file.
template <typename Case>
class Quietly : public testing::TestWithParam<Case> {
protected:
    void SetUp() override { osg::setNotifyLevel(osg::ALWAYS); }
    void TearDown() override { osg::setNotifyLevel(osg::NOTICE); }
};

class HostileFile : public Quietly<const char*> {};

/// The offset of the model's block; everything from there on is in our classes.
std::size_t ourPart(const std::string& file) {
    for (const char* name : {"osgSkin::SkinModel", "osgSkin--SkinModel"})
        if (file.find(name) != std::string::npos) return file.find(name);
    return std::string::npos;
}

void expectWholeOrNone(osg::Node* node) {
    if (!node) return;
    for (const osgSkin::DeformableSkin* skin : test::skinsOf(*node)) {
        if (!skin->getModel()) continue;
        EXPECT_EQ(skin->getModel()->vertexCount(),
                  skin->getRestGeometry()->getVertexArray()->getNumElements());
        EXPECT_NE(skin->getDeformedGeometry(), nullptr);
    }
}

} // namespace

TEST_P(HostileFile, CutShortInTheModelIsRefused) {
    const std::string good = test::save(*test::makeScene(), GetParam());
    const std::size_t start = ourPart(good);
    ASSERT_NE(start, std::string::npos);
    // After that, OSG's XML parser accepts anything.
    const std::size_t end = good.find("</osgSkin--SkinModel", start);
    for (std::size_t size = start; size + 1000 < std::min(end, good.size()); size += 211)
        EXPECT_EQ(test::load(good.substr(0, size), GetParam()), nullptr) << size;
    for (std::size_t size = end; size < good.size(); size += 97)
        expectWholeOrNone(test::load(good.substr(0, size), GetParam()));
}

TEST_P(HostileFile, AlteredInTheModelIsWholeOrRefused) {
    const std::string good = test::save(*test::makeScene(), GetParam());
    const std::size_t start = ourPart(good) + 24;
    for (std::size_t place = start; place < good.size(); place += 97) {
        std::string bad = good;
        bad[place] = std::string(GetParam()) == "osgb" ? static_cast<char>(bad[place] ^ 0xff) : '9';
        expectWholeOrNone(test::load(bad, GetParam()));
    }
}

TEST_P(HostileFile, ReasonIsNamed) {
    if (std::string(GetParam()) == "osgb") GTEST_SKIP() << "text formats only";
    std::string bad = test::save(*test::makeScene(), GetParam());
    // The first row of the block: its length, the number of joints, the root's parent.
    const std::string row = "16 3 4294967295 ";
    const std::size_t start = bad.find(row, ourPart(bad));
    ASSERT_NE(start, std::string::npos);
    bad.replace(start, row.size(), "16 3 1 ");
    std::string reason;
    EXPECT_EQ(test::load(bad, GetParam(), &reason), nullptr);
    EXPECT_NE(reason.find("after its parent"), std::string::npos) << reason;
}

namespace {

struct BadPrimitives {
    const char* name;
    const char* reason;
    osg::ref_ptr<osg::PrimitiveSet> primitives;
};
void PrintTo(const BadPrimitives& bad, std::ostream* out) {
    *out << bad.name;
}

osg::ref_ptr<osg::PrimitiveSet> runs(const std::vector<int>& lengths, int first = 0) {
    osg::ref_ptr<osg::DrawArrayLengths> made = new osg::DrawArrayLengths(
        GL_TRIANGLE_FAN, first, static_cast<unsigned int>(lengths.size()));
    std::copy(lengths.begin(), lengths.end(), made->begin());
    return made;
}
osg::ref_ptr<osg::PrimitiveSet> runs(const std::vector<int>& firsts,
                                     const std::vector<int>& counts) {
    osg::ref_ptr<osg::MultiDrawArrays> made = new osg::MultiDrawArrays(GL_TRIANGLE_FAN);
    made->setFirsts(firsts);
    made->setCounts(counts);
    return made;
}

constexpr int kMax = 0x7fffffff;
// OSG's own sums of the first case are 2 and 3.
const std::vector<BadPrimitives> kBadPrimitives = {
    {"LengthsThatWrap", "names vertex", runs({kMax, kMax, 4})},
    {"LengthsOfBothSigns", "of -3 corners", runs({3, -3, 3})},
    {"LengthsFromBefore", "names vertex -4", runs({3, 3}, -4)},
    {"FewerFirstsThanCounts", "1 first vertices of 2 runs", runs({0}, {3, 3})},
    {"FirstBeyond", "names vertex", runs({0, kMax}, {3, 3})},
    {"CountOfLess", "of -1 corners", runs({0, 0}, {3, -1})},
    {"HalfATriangle", "4 corners of triangles", new osg::DrawElementsUInt(GL_TRIANGLES, 4)},
};

class HostilePrimitives : public Quietly<BadPrimitives> {};

osg::ref_ptr<osg::Node> loadWith(osg::PrimitiveSet* primitives, std::string* reason) {
    const osg::ref_ptr<osg::Group> scene = test::makeScene();
    for (const osgSkin::DeformableSkin* skin : test::skinsOf(*scene))
        const_cast<osg::Geometry*>(skin->getRestGeometry())->setPrimitiveSet(0, primitives);
    return test::load(test::save(*scene, "osgb"), "osgb", reason);
}

} // namespace

TEST_P(HostilePrimitives, AreRefused) {
    std::string reason;
    EXPECT_EQ(loadWith(GetParam().primitives, &reason), nullptr);
    EXPECT_NE(reason.find(GetParam().reason), std::string::npos) << reason;
}

TEST(Primitives, GoodRunsAreRead) {
    for (const osg::ref_ptr<osg::PrimitiveSet>& good : {runs({3, 0, 4}, 1), runs({0, 4}, {3, 4})})
        EXPECT_NE(loadWith(good, nullptr), nullptr) << good->className();
}

TEST(RestArrays, AreAsLongAsWhatTheyAreBoundTo) {
    struct Case {
        osg::Array::Binding binding;
        unsigned int missing, enough;
    };
    const unsigned int vertices = test::skinsOf(*test::makeScene())
                                      .front()
                                      ->getRestGeometry()
                                      ->getVertexArray()
                                      ->getNumElements();
    for (const Case& of :
         {Case{osg::Array::BIND_OVERALL, 0, 1}, Case{osg::Array::BIND_PER_PRIMITIVE_SET, 0, 1},
          Case{osg::Array::BIND_PER_VERTEX, vertices - 1, vertices}})
        for (const unsigned int count : {of.missing, of.enough}) {
            const osg::ref_ptr<osg::Group> scene = test::makeScene();
            for (const osgSkin::DeformableSkin* skin : test::skinsOf(*scene))
                const_cast<osg::Geometry*>(skin->getRestGeometry())
                    ->setColorArray(new osg::Vec4Array(count), of.binding);
            std::string reason;
            const osg::ref_ptr<osg::Node> loaded =
                test::load(test::save(*scene, "osgb"), "osgb", &reason);
            EXPECT_EQ(loaded.valid(), count == of.enough) << of.binding << ": " << reason;
            EXPECT_EQ(reason.find("elements, expected at least") != std::string::npos,
                      count == of.missing)
                << reason;
        }
}

TEST(Primitives, EndAtTheLastVertex) {
    for (const unsigned int last : {2u, 3u}) {
        const osg::ref_ptr<osg::DrawElementsUShort> elements =
            new osg::DrawElementsUShort(GL_TRIANGLES);
        for (const unsigned int corner : {0u, 1u, last}) elements->addElement(corner);
        const osg::ref_ptr<osg::PrimitiveSet> run =
            new osg::DrawArrays(GL_TRIANGLES, static_cast<int>(last) - 2, 3);
        for (osg::PrimitiveSet* each : {static_cast<osg::PrimitiveSet*>(elements), run.get()}) {
            const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
            geometry->addPrimitiveSet(each);
            EXPECT_EQ(osgSkin::brokenPrimitive(*geometry, 3).empty(), last == 2)
                << each->className();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, HostilePrimitives, testing::ValuesIn(kBadPrimitives),
                         [](const auto& bad) { return std::string(bad.param.name); });

INSTANTIATE_TEST_SUITE_P(Formats, HostileFile, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& format) { return std::string(format.param); });
