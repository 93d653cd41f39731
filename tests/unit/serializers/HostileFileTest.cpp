// SPDX-License-Identifier: MIT
// Files cut short or altered where our own classes stand in them: no crash, and no half character.
#include "SavedScene.h"

#include <osg/Notify>

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

namespace {

/// Other than our reasons, OSG says of a bad file what it makes of each word in it.
template <typename Case>
class Quietly : public testing::TestWithParam<Case> {
protected:
    void SetUp() override { osg::setNotifyLevel(osg::ALWAYS); }
    void TearDown() override { osg::setNotifyLevel(osg::NOTICE); }
};

class HostileFile : public Quietly<const char*> {};

/// Where the model's block starts: far enough back to be in our classes from there on.
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
    // Further on, OSG's XML parser makes do with what is there.
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
    // The first row of the block: its length, then the version.
    const std::size_t row = bad.find("16 1 3 ", ourPart(bad));
    ASSERT_NE(row, std::string::npos);
    bad[row + 3] = '7';
    std::string reason;
    EXPECT_EQ(test::load(bad, GetParam(), &reason), nullptr);
    EXPECT_NE(reason.find("version 7"), std::string::npos) << reason;
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

constexpr int kMost = 0x7fffffff;
// OSG's own sums of the first are 2 and 3.
const std::vector<BadPrimitives> kBadPrimitives = {
    {"LengthsThatWrap", "names vertex", runs({kMost, kMost, 4})},
    {"LengthsOfBothSigns", "of -3 corners", runs({3, -3, 3})},
    {"LengthsFromBefore", "names vertex -4", runs({3, 3}, -4)},
    {"FewerFirstsThanCounts", "1 first vertices of 2 runs", runs({0}, {3, 3})},
    {"FirstBeyond", "names vertex", runs({0, kMost}, {3, 3})},
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
