// SPDX-License-Identifier: GPL-3.0-or-later
#include "Shapes.h"

#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinBind/ConvertRigs>

#include <osg/FrameStamp>
#include <osg/MatrixTransform>
#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/UpdateBone>
#include <osgUtil/UpdateVisitor>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace osgSkin;

namespace {

const std::array<double, 3> kHeights{0.6, 3.0, 5.5};

/// How a vertex at a height is painted: one weight a bone.
using Paint = std::array<float, 3> (*)(double height);

std::array<float, 3> rigid(double height) {
    return {height < 3.0 ? 1.0f : 0.0f, height >= 3.0 && height < 5.5 ? 1.0f : 0.0f,
            height >= 5.5 ? 1.0f : 0.0f};
}

std::array<float, 3> blended(double height) {
    const auto share = [height](double at) {
        return float(std::clamp(height - at + 0.5, 0.0, 1.0));
    };
    const float low = share(3.0), high = share(5.5);
    return {1.0f - low, low - high, high};
}

/// A cylinder as a rig of osgAnimation over a chain of three bones.
osg::ref_ptr<osgAnimation::RigGeometry> makeRig(Paint paint, const std::string& name = "rig") {
    const SkinMesh mesh = shapes::cylinder();
    const osg::ref_ptr<osg::Geometry> source = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec2Array> texCoords = new osg::Vec2Array;
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    for (const glm::dvec3& p : mesh.positions) {
        const std::array<float, 3> weights = paint(p.y);
        for (std::size_t b = 0; b < 3; ++b)
            if (weights[b] > 0.0f)
                (*map)["bone" + std::to_string(b)].emplace_back(unsigned(vertices->size()),
                                                                weights[b]);
        vertices->push_back(osg::Vec3(toOsg(p)));
        texCoords->push_back(osg::Vec2(float(vertices->size()), 0.5f));
    }
    const std::vector<std::uint32_t> corners = mesh.triangles();
    source->setVertexArray(vertices);
    source->setTexCoordArray(0, texCoords, osg::Array::BIND_PER_VERTEX);
    source->addPrimitiveSet(
        new osg::DrawElementsUInt(GL_TRIANGLES, unsigned(corners.size()), corners.data()));
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setName(name);
    rig->setSourceGeometry(source);
    rig->setInfluenceMap(map);
    return rig;
}

struct Scene {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    std::vector<osg::ref_ptr<osgAnimation::Bone>> bones;

    Scene() {
        skeleton->setDefaultUpdateCallback();
        root->addChild(skeleton);
        osg::Group* above = skeleton;
        double below = 0.0;
        for (std::size_t b = 0; b < kHeights.size(); ++b) {
            const std::string name = "bone" + std::to_string(b);
            bones.push_back(new osgAnimation::Bone(name));
            const osg::ref_ptr<osgAnimation::UpdateBone> update =
                new osgAnimation::UpdateBone(name);
            update->getStackedTransforms().push_back(new osgAnimation::StackedMatrixElement(
                "matrix", osg::Matrix::translate(0, kHeights[b] - below, 0)));
            bones.back()->setUpdateCallback(update);
            bones.back()->setInvBindMatrixInSkeletonSpace(
                osg::Matrix::translate(0, -kHeights[b], 0));
            above->addChild(bones.back());
            above = bones.back();
            below = kHeights[b];
        }
    }

    /// Turns and moves the bones, and lets an update traversal carry it to the skins.
    void pose(const std::vector<osg::Quat>& turns, const osg::Vec3d& step) {
        double below = 0.0;
        for (std::size_t b = 0; b < bones.size(); ++b) {
            auto& update = dynamic_cast<osgAnimation::UpdateBone&>(*bones[b]->getUpdateCallback());
            auto& element = static_cast<osgAnimation::StackedMatrixElement&>(
                *update.getStackedTransforms().front());
            element.setMatrix(osg::Matrix::rotate(turns[b]) *
                              osg::Matrix::translate(0, kHeights[b] - below, 0) *
                              osg::Matrix::translate(b == 0 ? step : osg::Vec3d()));
            below = kHeights[b];
        }
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(stamp);
        root->accept(visitor);
    }

    osg::Matrixd skinning(std::size_t bone) const {
        return bones[bone]->getInvBindMatrixInSkeletonSpace() *
               bones[bone]->getMatrixInSkeletonSpace();
    }
};

const osg::Vec3Array& verticesOf(const osg::Geometry& geometry) {
    return static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
}

/// Which vertex of the source a skin's vertex was: its texture coordinate tells.
std::size_t sourceOf(const osg::Geometry& geometry, std::size_t vertex) {
    const auto& coordinates = static_cast<const osg::Vec2Array&>(*geometry.getTexCoordArray(0));
    return std::size_t(coordinates[vertex].x()) - 1;
}

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

TEST(ConvertRigs, KeepTheRestPoseToTheLastBit) {
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

TEST(ConvertRigs, RigidWeightsMoveAsLinearBlendingDoes) {
    Scene scene;
    scene.skeleton->addChild(makeRig(rigid));
    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 1u);
    std::mt19937 random(1);
    const double size = shapes::cylinder().size();
    for (int i = 0; i < 100; ++i) {
        scene.pose(someTurns(random), {0.3 * i, -2.0, 1.0});
        // Beside the rounding of floats as far from the origin as the figure walks.
        EXPECT_LT(differenceFromLinear(scene, *report.skins[0], rigid),
                  1e-5 * std::max(size, 0.3 * i));
    }
}

TEST(ConvertRigs, BlendedWeightsTakeTheModelsTurnAndEndWhereTheBonesDo) {
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
        // A twist: linear blending shrinks the tube to a candy wrapper, the model keeps its radius.
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

TEST(ConvertRigs, AreReplacedWhereTheyStand) {
    Scene scene;
    const osg::ref_ptr<osg::Group> dresser = new osg::Group;
    const osg::ref_ptr<osg::Node> before = new osg::Node, after = new osg::Node;
    const auto rig = makeRig(blended, "coat");
    rig->setNodeMask(0x10);
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
    EXPECT_EQ(report.skins[0]->getStateSet(), rig->getStateSet());
    EXPECT_NE(dynamic_cast<UpdateDeformableSkin*>(report.skins[0]->getUpdateCallback()), nullptr);
    EXPECT_EQ(scene.bones[1]->getUpdateCallback(), callback);
    EXPECT_TRUE(convertRigs(*scene.root).skins.empty()) << "nothing is left to convert";
}

TEST(ConvertRigs, RigUnderATransformComesToStandUnderItsSkeleton) {
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

TEST(ConvertRigs, SeveralRigsOfOneSkeletonKeepTheirSeamsClosed) {
    Scene scene;
    scene.skeleton->addChild(makeRig(blended, "skin"));
    // The same places, painted otherwise: without a common binding they would come apart.
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

TEST(ConvertRigs, OwnBindingNeedsNoGoodWeights) {
    Scene scene;
    const auto all = [](double) { return std::array<float, 3>{1.0f, 0.0f, 0.0f}; };
    scene.skeleton->addChild(makeRig(all));
    ConvertOptions options;
    options.ratios = ConvertOptions::Ratios::Best; // one bone only: not worth following
    options.bind.joints["of another skeleton"].skip = true;
    const ConvertReport report = convertRigs(*scene.root, options);
    ASSERT_EQ(report.skins.size(), 1u);
    scene.pose({osg::Quat(), osg::Quat(1.0, osg::Vec3d(1, 0, 0)), osg::Quat()}, {});
    EXPECT_GT(differenceFromLinear(scene, *report.skins[0], all), 0.5);
}

TEST(ConvertRigs, LeaveAloneWhatTheyCannotConvertAndSayWhy) {
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
    const auto lost = makeRig(blended, "lost");
    for (const auto& rig : {morph, unpainted, stray, points, infinite})
        scene.skeleton->addChild(rig);
    scene.root->addChild(lost);
    scene.skeleton->addChild(makeRig(blended, "good"));

    const ConvertReport report = convertRigs(*scene.root);
    ASSERT_EQ(report.skins.size(), 1u);
    EXPECT_EQ(report.skins[0]->getName(), "good");
    const std::pair<const char*, const char*> expected[] = {
        {"face", "morph targets"},  {"unpainted", "no weights"}, {"stray", "not there"},
        {"points", "no triangles"}, {"infinite", "not finite"},  {"lost", "no skeleton"},
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
    for (const auto& rig : {morph, unpainted, stray, points, infinite})
        EXPECT_TRUE(scene.skeleton->containsNode(rig)) << rig->getName();
}
