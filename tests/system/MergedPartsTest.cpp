// SPDX-License-Identifier: MIT
//
// Rigid parts drawn with the skin (rigid=merged).
#include "FindNodes.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/RigidPart>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/ref_ptr>

#include <array>
#include <map>
#include <string>

namespace {

using osgSkin::Character;
using osgSkin::DeformableSkin;
using osgSkin::RigidPart;

Character loadThrower(bool merged) {
    osgSkin::LoadOptions options;
    options.shapes = osgSkin::BindOptions::Shapes::None;
    options.mergeRigid = merged;
    return osgSkin::loadCharacter(OSGSKIN_DATA "/thrower.skin", options);
}

struct Drawn {
    osg::Vec3d position, normal; ///< in the world
};

/// The vertices that the body draws at a time, by their rest positions.
std::map<std::array<float, 3>, Drawn> drawnAt(osg::Node& scene, double time) {
    test::updateAt(scene, time);
    std::map<std::array<float, 3>, Drawn> drawn;
    const auto add = [&](const osg::Geometry& rest, const osg::Geometry& posed,
                         const osg::Matrixd& toWorld) {
        const auto at = [](const osg::Array* array, unsigned int i) {
            return static_cast<const osg::Vec3Array&>(*array)[i];
        };
        for (unsigned int i = 0; i < rest.getVertexArray()->getNumElements(); ++i) {
            const osg::Vec3 key = at(rest.getVertexArray(), i);
            osg::Vec3d normal =
                osg::Matrixd::transform3x3(osg::Vec3d(at(posed.getNormalArray(), i)), toWorld);
            normal.normalize();
            drawn[{key.x(), key.y(), key.z()}] = {
                osg::Vec3d(at(posed.getVertexArray(), i)) * toWorld, normal};
        }
    };
    for (const auto& found : test::findNodes<RigidPart>(scene)) {
        const osg::Geometry* geometry = found.node->getChild(0)->asGeometry();
        add(*geometry, *geometry, found.toWorld);
    }
    for (const auto& found : test::findNodes<DeformableSkin>(scene))
        add(*found.node->getRestGeometry(), *found.node->getDeformedGeometry(), found.toWorld);
    return drawn;
}

void expectEqual(osg::Node& scene, osg::Node& expected) {
    const double size = 2.0 * static_cast<double>(expected.getBound().radius());
    for (const double time : {0.0, 0.7, 1.4, 2.3}) {
        const auto are = drawnAt(scene, time), were = drawnAt(expected, time);
        ASSERT_EQ(are.size(), were.size());
        double farthest = 0.0, turned = 0.0;
        for (const auto& [rest, was] : were) {
            ASSERT_EQ(are.count(rest), 1u);
            const Drawn& is = are.at(rest);
            farthest = std::max(farthest, (is.position - was.position).length());
            turned = std::max(turned, (is.normal - was.normal).length());
        }
        EXPECT_LE(farthest, 1e-6 * size) << time;
        EXPECT_LE(turned, 1e-4) << time;
    }
}

std::size_t skinsIn(osg::Node& scene) {
    return test::findNodes<DeformableSkin>(scene).size();
}

std::size_t partsIn(osg::Node& scene) {
    return test::findNodes<RigidPart>(scene).size();
}

} // namespace

TEST(MergedParts, MoveAsSeparatePartsDo) {
    const Character separate = loadThrower(false), merged = loadThrower(true);
    EXPECT_GE(partsIn(*separate.root), 1u);
    EXPECT_EQ(partsIn(*merged.root), 0u);
    EXPECT_EQ(skinsIn(*merged.root), 1u);
    EXPECT_EQ(merged.binding.influences.size(), separate.binding.influences.size());
    expectEqual(*merged.root, *separate.root);
}

TEST(MergedParts, LoadsOfOneFileShareTheModel) {
    const Character first = loadThrower(false), second = loadThrower(false);
    const DeformableSkin &a = *first.skin.skins.front().drawable,
                         &b = *second.skin.skins.front().drawable;
    EXPECT_EQ(a.getModel(), b.getModel());
    EXPECT_EQ(a.getRestGeometry()->getVertexArray(), b.getRestGeometry()->getVertexArray());
    EXPECT_EQ(first.skin.rigids.front().part.geometry->getVertexArray(),
              second.skin.rigids.front().part.geometry->getVertexArray());
    EXPECT_NE(loadThrower(true).skin.skins.front().drawable->getModel(), a.getModel());
}
