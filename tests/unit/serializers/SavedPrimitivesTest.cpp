// SPDX-License-Identifier: MIT
#include "SavedScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

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

class HostilePrimitives : public test::Quietly<BadPrimitives> {};

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

TEST(SavedPrimitives, ValidRunsAreRead) {
    for (const osg::ref_ptr<osg::PrimitiveSet>& good : {runs({3, 0, 4}, 1), runs({0, 4}, {3, 4})})
        EXPECT_NE(loadWith(good, nullptr), nullptr) << good->className();
}

TEST(RestArrays, TooShortForTheirBindingAreRefused) {
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

TEST(SavedPrimitives, RejectIndicesPastTheLastVertex) {
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
