// SPDX-License-Identifier: MIT
// Changes that OSG's programs make to a scene between reading and drawing must leave the posed
// figure at the scene's position.
#include "Command.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/RigidPart>

#include <gtest/gtest.h>
#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgUtil/Optimizer>

#include <cstdlib>
#include <ostream>

namespace {

const std::string kThrowerFile = OSGSKIN_DATA "/thrower.skin";

/// World-space positions of a scene's skins and rigid parts.
class Collector : public osg::NodeVisitor {
public:
    std::vector<osg::Vec3d> skin;
    osg::BoundingBox rigid;

    Collector() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override {
        const osg::Matrix toWorld = osg::computeLocalToWorld(getNodePath());
        if (auto* deformable = dynamic_cast<osgSkin::DeformableSkin*>(&drawable)) {
            for (const osg::Vec3& v : static_cast<const osg::Vec3Array&>(
                     *deformable->getDeformedGeometry()->getVertexArray()))
                skin.push_back(osg::Vec3d(v) * toWorld);
            return;
        }
        for (osg::Node* node : getNodePath())
            if (dynamic_cast<osgSkin::RigidPart*>(node))
                for (unsigned int corner = 0; corner < 8; ++corner)
                    rigid.expandBy(drawable.getBoundingBox().corner(corner) * toWorld);
    }
};

Collector at(double time, osg::Node& scene) {
    test::updateAt(scene, time);
    Collector collector;
    scene.accept(collector);
    return collector;
}

/// At several times `scene` must equal the plain thrower moved by `move`.
void expectPlaced(osg::Node* scene, const osg::Matrix& move) {
    ASSERT_NE(scene, nullptr);
    const osg::ref_ptr<osg::Node> plain = osgDB::readRefNodeFile(kThrowerFile);
    ASSERT_NE(plain, nullptr);
    for (const double time : {0.0, 0.9, 1.3, 2.1}) {
        const Collector is = at(time, *scene);
        const Collector expected = at(time, *plain);
        ASSERT_EQ(is.skin.size(), expected.skin.size());
        double off = 0.0;
        for (std::size_t v = 0; v < is.skin.size(); ++v)
            off = std::max(off, (is.skin[v] - expected.skin[v] * move).length());
        EXPECT_LE(off, 1e-5) << time;
        osg::BoundingBox rigid;
        for (unsigned int corner = 0; corner < 8; ++corner)
            rigid.expandBy(expected.rigid.corner(corner) * move);
        EXPECT_LE((is.rigid._min - rigid._min).length(), 1e-4) << time;
        EXPECT_LE((is.rigid._max - rigid._max).length(), 1e-4) << time;
    }
}

struct PseudoLoader {
    const char* name;
    const char* suffix;
    osg::Matrix move;
};

void PrintTo(const PseudoLoader& loader, std::ostream* out) {
    *out << loader.name;
}

class Placement : public testing::TestWithParam<PseudoLoader> {};

// Right angles, so that a box of rotated boxes equals the rotated box.
const PseudoLoader kLoaders[] = {
    {"plain", "", osg::Matrix()},
    {"trans", ".2,3,4.trans", osg::Matrix::translate(2, 3, 4)},
    {"scale", ".2.scale", osg::Matrix::scale(2, 2, 2)},
    {"rot", ".0,0,90.rot", osg::Matrix::rotate(osg::PI_2, osg::Vec3(0, 0, 1))},
};

} // namespace

TEST_P(Placement, AsRead) {
    expectPlaced(osgDB::readRefNodeFile(kThrowerFile + GetParam().suffix).get(), GetParam().move);
}

TEST_P(Placement, AfterEveryOptimization) {
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(kThrowerFile + GetParam().suffix);
    ASSERT_NE(scene, nullptr);
    osgUtil::Optimizer().optimize(scene, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    expectPlaced(scene.get(), GetParam().move);
}

TEST_P(Placement, AfterOsgconv) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "osgconv cannot load libraries that were built with sanitizers";
#endif
    const std::string saved = test::makeTestFolder() + "/saved.osgb";
    const std::string command =
        "osgconv '" + kThrowerFile + GetParam().suffix + "' '" + saved + "' >/dev/null 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0); // NOLINT(cert-env33-c): our own arguments
    expectPlaced(osgDB::readRefNodeFile(saved).get(), GetParam().move);
}

INSTANTIATE_TEST_SUITE_P(Loaders, Placement, testing::ValuesIn(kLoaders),
                         [](const auto& loader) { return std::string(loader.param.name); });
