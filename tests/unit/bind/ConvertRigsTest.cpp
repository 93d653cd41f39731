// SPDX-License-Identifier: GPL-3.0-or-later
#include "RigScene.h"
#include "Shapes.h"

#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinBind/ConvertRigs>

#include <gtest/gtest.h>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osgAnimation/MorphGeometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace osgSkin;
using namespace rigs;

namespace {

/// Largest distance of the skin from linear blending with `paint`.
double differenceFromLinear(const Scene& scene, const DeformableSkin& skin, Paint paint) {
    const SkinMesh mesh = shapes::cylinder();
    const osg::Geometry& posed = *skin.getDeformedGeometry();
    double worst = 0.0;
    for (std::size_t v = 0; v < verticesOf(posed).size(); ++v) {
        const glm::dvec3& rest = mesh.positions[sourceOf(posed, v)];
        const std::array<float, 3> weights = paint(rest.y);
        osg::Vec3d sum;
        for (std::size_t b = 0; b < 3; ++b)
            sum += toOsg(rest) * scene.skinning(b) * double(weights[b]);
        worst = std::max(worst, (sum - osg::Vec3d(verticesOf(posed)[v])).length());
    }
    return worst;
}

std::vector<osg::Quat> someTurns(std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::vector<osg::Quat> turns;
    for (int b = 0; b < 3; ++b) {
        osg::Quat q(normal(random), normal(random), normal(random), normal(random));
        turns.push_back(q / q.length());
    }
    return turns;
}

} // namespace

TEST(ConvertRigs, RestPoseIsBitIdentical) {
    Scene scene;
    const auto rig = makeRig(blended);
    scene.skeleton->addChild(rig);
    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 1u);
    EXPECT_TRUE(report.notes.empty());
    scene.pose({osg::Quat(), osg::Quat(), osg::Quat()}, {});
    const osg::Geometry& posed = *report.skins[0]->getDeformedGeometry();
    const osg::Vec3Array& source = verticesOf(*rig->getSourceGeometry());
    ASSERT_EQ(verticesOf(posed).size(), source.size());
    for (std::size_t v = 0; v < source.size(); ++v)
        EXPECT_EQ(verticesOf(posed)[v], source[sourceOf(posed, v)]) << "vertex " << v;
}

TEST(ConvertRigs, RigidWeightsMatchLinearBlending) {
    Scene scene;
    scene.skeleton->addChild(makeRig(rigid));
    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 1u);
    std::mt19937 random(1);
    const double size = shapes::cylinder().size();
    for (int i = 0; i < 100; ++i) {
        scene.pose(someTurns(random), {0.3 * i, -2.0, 1.0});
        // The tolerance is the rounding of floats as far from the origin as the figure walks.
        EXPECT_LT(differenceFromLinear(scene, *report.skins[0], rigid),
                  1e-5 * std::max(size, 0.3 * i));
    }
}

TEST(ConvertRigs, BlendedWeightsKeepTheRadiusWhenTwisted) {
    Scene scene;
    scene.skeleton->addChild(makeRig(blended));
    const ConvertReport report = convertRigs(*scene.root);
    scene.pose({osg::Quat(), osg::Quat(2.8, osg::Vec3d(0, 1, 0)), osg::Quat()}, {});
    const SkinMesh mesh = shapes::cylinder();
    const osg::Geometry& posed = *report.skins.at(0)->getDeformedGeometry();
    double linearRadius = 1.0;
    for (std::size_t v = 0; v < verticesOf(posed).size(); ++v) {
        const glm::dvec3& rest = mesh.positions[sourceOf(posed, v)];
        const osg::Vec3& p = verticesOf(posed)[v];
        // A twist: linear blending collapses the tube like a candy wrapper, the model keeps its
        // radius.
        const double radius = std::hypot(rest.x, rest.z);
        EXPECT_NEAR(std::hypot(double(p.x()), double(p.z())), radius, 1e-4);
        const std::array<float, 3> weights = blended(rest.y);
        osg::Vec3d sum;
        for (std::size_t b = 0; b < 3; ++b)
            sum += toOsg(rest) * scene.skinning(b) * double(weights[b]);
        if (radius > 0.9) linearRadius = std::min(linearRadius, std::hypot(sum.x(), sum.z()));
    }
    EXPECT_LT(linearRadius, 0.5);
}

TEST(ConvertRigs, ReplacesRigInPlaceAndKeepsItsState) {
    Scene scene;
    const osg::ref_ptr<osg::Group> dresser = new osg::Group;
    const osg::ref_ptr<osg::Node> before = new osg::Node, after = new osg::Node;
    const auto rig = makeRig(blended, "coat");
    rig->setNodeMask(0x10);
    const osg::ref_ptr<osg::NodeCallback> culls = new osg::NodeCallback;
    const osg::ref_ptr<osg::NodeCallback> hears = new osg::NodeCallback;
    rig->setCullCallback(culls);
    rig->setEventCallback(hears);
    rig->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    for (osg::Node* child : {before.get(), static_cast<osg::Node*>(rig), after.get()})
        dresser->addChild(child);
    scene.skeleton->addChild(dresser);
    const osg::ref_ptr<osg::Callback> callback = scene.bones[1]->getUpdateCallback();
    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 1u);
    ASSERT_EQ(dresser->getNumChildren(), 3u);
    EXPECT_EQ(dresser->getChild(1), report.skins[0]);
    EXPECT_EQ(report.skins[0]->getName(), "coat");
    EXPECT_EQ(report.skins[0]->getNodeMask(), 0x10u);
    EXPECT_EQ(report.skins[0]->getCullCallback(), culls);
    EXPECT_EQ(report.skins[0]->getEventCallback(), hears);
    EXPECT_EQ(report.skins[0]->getStateSet(), rig->getStateSet());
    EXPECT_NE(dynamic_cast<UpdateDeformableSkin*>(report.skins[0]->getUpdateCallback()), nullptr);
    EXPECT_EQ(scene.bones[1]->getUpdateCallback(), callback);
    EXPECT_TRUE(convertRigs(*scene.root).skins.empty()) << "nothing is left to convert";
}

TEST(ConvertRigs, MovesRigFromTransformToSkeleton) {
    Scene scene;
    const osg::ref_ptr<osg::MatrixTransform> aside = new osg::MatrixTransform;
    aside->setMatrix(osg::Matrix::translate(0, 0, 4));
    aside->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    aside->addChild(makeRig(rigid));
    scene.skeleton->addChild(aside);
    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 1u);
    EXPECT_EQ(aside->getNumChildren(), 0u);
    const osg::Group& parent = *report.skins[0]->getParent(0);
    EXPECT_EQ(parent.getStateSet()->getMode(GL_CULL_FACE), osg::StateAttribute::ON);
    const osg::Geometry& rest = *report.skins[0]->getRestGeometry();
    const SkinMesh mesh = shapes::cylinder();
    for (std::size_t v = 0; v < verticesOf(rest).size(); ++v)
        EXPECT_NEAR(double(verticesOf(rest)[v].z()), mesh.positions[sourceOf(rest, v)].z + 4.0,
                    1e-5);
}

TEST(ConvertRigs, NotesLostUpdateCallbacks) {
    Scene scene;
    const auto rig = makeRig(blended, "coat");
    rig->addUpdateCallback(new osg::NodeCallback);
    rig->setCullingActive(false);
    scene.skeleton->addChild(rig);
    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 1u);
    EXPECT_FALSE(report.skins[0]->getCullingActive());
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0], "rig \"coat\" loses its own update callback");
}

TEST(ConvertRigs, NotesAnimatedTransformsAboveRigs) {
    for (const bool away : {false, true})
        for (const bool moves : {false, true}) {
            Scene scene;
            const osg::ref_ptr<osg::MatrixTransform> aside = new osg::MatrixTransform;
            if (away) aside->setMatrix(osg::Matrix::translate(0, 0, 4));
            if (moves) aside->setUpdateCallback(new osg::NodeCallback);
            aside->addChild(makeRig(rigid));
            scene.skeleton->addChild(aside);
            const ConvertReport report = convertRigs(*scene.root);
            ASSERT_EQ(report.skins.size(), 1u);
            EXPECT_EQ(aside->getNumChildren(), away ? 0u : 1u);
            ASSERT_EQ(report.notes.size(), away && moves ? 1u : 0u);
            if (away && moves) {
                EXPECT_NE(report.notes[0].find("does not follow its transforms"),
                          std::string::npos);
            }
        }
}

/// Outside its transform it would be drawn at all distances, or although it is switched off.
TEST(ConvertRigs, KeepsRigsUnderLodAndSwitch) {
    for (const double aside : {0.0, 4.0})
        for (const bool far : {false, true}) {
            Scene scene;
            const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
            place->setMatrix(osg::Matrix::translate(0, 0, aside));
            place->addChild(makeRig(rigid));
            const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
            const osg::ref_ptr<osg::Switch> choice = new osg::Switch;
            if (far)
                levels->addChild(place, 10.0f, 1e9f);
            else
                choice->addChild(place, false);
            scene.skeleton->addChild(far ? static_cast<osg::Group*>(levels) : choice.get());
            const ConvertReport report = convertRigs(*scene.root);
            EXPECT_EQ(report.skins.size(), aside == 0.0 ? 1u : 0u);
            EXPECT_EQ(report.notes.size(), aside == 0.0 ? 0u : 1u);
            EXPECT_EQ(place->getNumChildren(), 1u);
        }
}

TEST(ConvertRigs, RigsOfOneSkeletonKeepTheirSeamsClosed) {
    Scene scene;
    scene.skeleton->addChild(makeRig(blended, "skin"));
    // The same positions with different weights: without a common binding they would separate.
    scene.skeleton->addChild(makeRig(rigid, "coat"));
    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 2u);
    std::mt19937 random(2);
    scene.pose(someTurns(random), {1, 2, 3});
    std::vector<osg::Vec3> skin(shapes::cylinder().positions.size());
    const osg::Geometry& first = *report.skins[0]->getDeformedGeometry();
    const osg::Geometry& second = *report.skins[1]->getDeformedGeometry();
    for (std::size_t v = 0; v < skin.size(); ++v) skin[sourceOf(first, v)] = verticesOf(first)[v];
    for (std::size_t v = 0; v < skin.size(); ++v)
        EXPECT_LT((verticesOf(second)[v] - skin[sourceOf(second, v)]).length(), 1e-6f);
}

TEST(ConvertRigs, BestRatiosIgnoreBadWeights) {
    Scene scene;
    const auto all = [](double) { return std::array<float, 3>{1.0f, 0.0f, 0.0f}; };
    scene.skeleton->addChild(makeRig(all));
    ConvertOptions options;
    options.ratios = ConvertOptions::Ratios::Best; // only one bone: not worth converting
    options.bind.joints["of another skeleton"].skip = true;
    const ConvertReport report = convertRigs(*scene.root, options);
    ASSERT_EQ(report.skins.size(), 1u);
    scene.pose({osg::Quat(), osg::Quat(1.0, osg::Vec3d(1, 0, 0)), osg::Quat()}, {});
    EXPECT_GT(differenceFromLinear(scene, *report.skins[0], all), 0.5);
}

TEST(ConvertRigs, SkipsUnsupportedRigsWithAReason) {
    Scene scene;
    const auto morph = makeRig(blended, "face");
    morph->setSourceGeometry(new osgAnimation::MorphGeometry(*morph->getSourceGeometry()));
    const auto unpainted = makeRig(blended, "unpainted");
    unpainted->setInfluenceMap(new osgAnimation::VertexInfluenceMap);
    const auto stray = makeRig(blended, "stray");
    (*stray->getInfluenceMap())["bone0"].emplace_back(100000u, 1.0f);
    const auto points = makeRig(blended, "points");
    points->getSourceGeometry()->setPrimitiveSet(0, new osg::DrawArrays(GL_POINTS, 0, 4));
    const auto infinite = makeRig(blended, "infinite");
    (*static_cast<osg::Vec3Array*>(infinite->getSourceGeometry()->getVertexArray()))[3].x() =
        INFINITY;
    const auto halved = makeRig(blended, "halved");
    const GLuint corners[] = {0, 1, 2, 0};
    halved->getSourceGeometry()->setPrimitiveSet(
        0, new osg::DrawElementsUInt(GL_TRIANGLES, 4, corners));
    const auto endless = makeRig(blended, "endless");
    endless->getSourceGeometry()->setPrimitiveSet(0,
                                                  new osg::DrawArrays(GL_TRIANGLES, 0, 2000000001));
    const auto lost = makeRig(blended, "lost");
    for (const auto& rig : {morph, unpainted, stray, points, infinite, halved, endless})
        scene.skeleton->addChild(rig);
    scene.root->addChild(lost);
    scene.skeleton->addChild(makeRig(blended, "good"));

    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 1u);
    EXPECT_EQ(report.skins[0]->getName(), "good");
    const std::pair<const char*, const char*> expected[] = {
        {"face", "morph targets"},   {"unpainted", "no weights"}, {"stray", "does not exist"},
        {"points", "no triangles"},  {"infinite", "not finite"},  {"lost", "no skeleton"},
        {"halved", "multiple of 3"}, {"endless", "names vertex"},
    };
    EXPECT_EQ(report.notes.size(), std::size(expected));
    for (const auto& pair : expected) {
        const std::string name = pair.first;
        const std::string reason = pair.second;
        const bool found =
            std::any_of(report.notes.begin(), report.notes.end(), [&](const std::string& note) {
                return note.find(name) != std::string::npos &&
                       note.find(reason) != std::string::npos;
            });
        EXPECT_TRUE(found) << name << ": " << reason;
    }
    for (const auto& rig : {morph, unpainted, stray, points, infinite, halved, endless})
        EXPECT_TRUE(scene.skeleton->containsNode(rig)) << rig->getName();
}
