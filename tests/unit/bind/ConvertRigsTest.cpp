// SPDX-License-Identifier: GPL-3.0-or-later
//
// Scaled bones: a converted skin compared with osgAnimation's result for the same rig.
#include "RigScene.h"
#include "Shapes.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/Bind>
#include <osgSkinBind/ConvertRigs>
#include <osgSkinBind/MakeSkins>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <osg/FrameStamp>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/Channel>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/UpdateBone>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
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
        // The tolerance is the rounding of floats as far from the origin as the figure walks.
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

TEST(ConvertRigs, AreReplacedWhereTheyStand) {
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

TEST(ConvertRigs, CallbacksThatSkinsCannotKeepAreToldOf) {
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

TEST(ConvertRigs, TransformsThatMoveARigAreToldOf) {
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
TEST(ConvertRigs, RigThatIsDrawnAtTimesStaysUnderItsTransform) {
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

TEST(ConvertRigs, SeveralRigsOfOneSkeletonKeepTheirSeamsClosed) {
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

TEST(ConvertRigs, OwnBindingNeedsNoGoodWeights) {
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

namespace {

osg::Matrixd& localOf(Scene& scene, std::size_t bone) {
    auto& update = dynamic_cast<osgAnimation::UpdateBone&>(*scene.bones[bone]->getUpdateCallback());
    auto& element =
        static_cast<osgAnimation::StackedMatrixElement&>(*update.getStackedTransforms().front());
    return const_cast<osg::Matrixd&>(element.getMatrix());
}

/// Sets the bones' own matrices: a rotation, then a scale, at the joint.
struct Local {
    osg::Quat turn;
    osg::Vec3d scale{1, 1, 1};
};

void pose(Scene& scene, const std::array<Local, 3>& locals, const std::array<double, 3>& offsets) {
    for (std::size_t b = 0; b < 3; ++b)
        localOf(scene, b) = osg::Matrixd::scale(locals[b].scale) *
                            osg::Matrixd::rotate(locals[b].turn) *
                            osg::Matrixd::translate(0, offsets[b], 0);
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    scene.root->accept(visitor);
}

const std::array<double, 3> kOffsets{kHeights[0], kHeights[1] - kHeights[0],
                                     kHeights[2] - kHeights[1]};

/// The same rig twice: one converted, one posed by osgAnimation itself.
struct Pair {
    Scene ours, theirs;
    osg::ref_ptr<osgAnimation::RigGeometry> rig;
    ConvertReport report;

    explicit Pair(Paint paint, const std::function<void(Scene&)>& change = {}) {
        ours.skeleton->addChild(makeRig(paint));
        rig = makeRig(paint);
        theirs.skeleton->addChild(rig);
        if (change)
            for (Scene* scene : {&ours, &theirs}) change(*scene);
        report = convertRigs(*ours.root);
        EXPECT_EQ(report.skins.size(), 1u);
    }

    double difference(const std::array<Local, 3>& locals,
                      const std::array<double, 3>& offsets = kOffsets) {
        for (Scene* scene : {&ours, &theirs}) pose(*scene, locals, offsets);
        // A rig finds its bones in its first update and is deformed in the second.
        pose(theirs, locals, offsets);
        const osg::Geometry& posed = *report.skins.at(0)->getDeformedGeometry();
        const osg::Vec3Array& expected = verticesOf(*rig);
        double worst = 0.0;
        for (std::size_t v = 0; v < verticesOf(posed).size(); ++v)
            worst = std::max(
                worst, double((verticesOf(posed)[v] - expected[sourceOf(posed, v)]).length()));
        const osg::BoundingBox& box = report.skins[0]->getBoundingBox();
        for (const osg::Vec3& v : verticesOf(posed))
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_TRUE(v[axis] > box._min[axis] - 1e-4f && v[axis] < box._max[axis] + 1e-4f);
        return worst;
    }
};

const std::array<Local, 3> kRest{};
const std::array<Local, 3> kTurned{Local{osg::Quat(0.4, osg::Vec3d(1, 2, 0))},
                                   Local{osg::Quat(0.9, osg::Vec3d(0, 1, 3))},
                                   Local{osg::Quat(-1.2, osg::Vec3d(1, 0, 1))}};

std::array<Local, 3> scaled(std::array<Local, 3> locals, const std::array<double, 3>& by) {
    for (std::size_t b = 0; b < 3; ++b) locals[b].scale = osg::Vec3d(by[b], by[b], by[b]);
    return locals;
}

constexpr double kSize = 6.5; ///< the cylinder's

} // namespace

/// As in FBX files in centimetres: the bones are scaled, also in the bind pose.
TEST(ConvertScale, ThatIsInTheBindPoseTooChangesNothing) {
    const std::array<double, 3> by{100.0, 0.5, 0.02};
    const std::array<double, 3> offsets{kOffsets[0], kOffsets[1] / 100.0, kOffsets[2] / 50.0};
    for (const Paint paint : {Paint(rigid), Paint(blended)}) {
        Pair pair(paint, [&](Scene& scene) {
            double size = 1.0;
            for (std::size_t b = 0; b < 3; ++b) {
                size *= by[b];
                scene.bones[b]->setInvBindMatrixInSkeletonSpace(
                    osg::Matrix::translate(0, -kHeights[b], 0) *
                    osg::Matrix::scale(1.0 / size, 1.0 / size, 1.0 / size));
            }
        });
        EXPECT_TRUE(pair.report.notes.empty());
        EXPECT_LT(pair.difference(scaled(kRest, by), offsets), 1e-6 * kSize);
        if (paint == Paint(rigid)) {
            EXPECT_LT(pair.difference(scaled(kTurned, by), offsets), 1e-6 * kSize);
        }
    }
}

TEST(ConvertScale, OfTheWholeFigureIsFollowed) {
    Pair painted(blended), rigidly(rigid);
    for (const double by : {2.0, 0.01, 30.0}) {
        EXPECT_LT(painted.difference(scaled(kRest, {by, 1, 1})), 1e-6 * kSize * by);
        EXPECT_LT(rigidly.difference(scaled(kTurned, {by, 1, 1})), 2e-6 * kSize * by);
    }
}

/// Animated from frame to frame, every bone separately.
TEST(ConvertScale, OfSingleBonesIsFollowed) {
    Pair rigidly(rigid), painted(blended);
    for (int frame = 0; frame < 40; ++frame) {
        const double t = 0.1 * frame;
        const std::array<double, 3> by{1.0 + 0.2 * std::sin(t), 1.0 + 0.5 * std::sin(2.0 * t),
                                       std::exp(std::sin(3.0 * t))};
        EXPECT_LT(rigidly.difference(scaled(kTurned, by)), 1e-5 * kSize) << "frame " << frame;
        EXPECT_LT(rigidly.difference(scaled(kRest, by)), 1e-5 * kSize) << "frame " << frame;
    }
    // One joint per vertex and no rotation: its share of the scale equals that of linear blending.
    EXPECT_LT(painted.difference(scaled(kRest, {1.0, 1.5, 1.0})), 1e-5 * kSize);
    EXPECT_LT(painted.difference(scaled(kRest, {1.0, 1.0, 0.4})), 1e-5 * kSize);
}

TEST(ConvertScale, AboveTheSkeletonIsTheScenes) {
    Pair pair(rigid, [](Scene& scene) {
        const osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(
            osg::Matrix::scale(0.01, 0.01, 0.01) * osg::Matrix::rotate(1.0, osg::Vec3d(1, 0, 0)));
        scene.root->removeChild(scene.skeleton);
        above->addChild(scene.skeleton);
        scene.root->addChild(above);
        scene.skeleton->setMatrix(osg::Matrix::scale(5, 5, 5));
    });
    EXPECT_TRUE(pair.report.notes.empty());
    EXPECT_LT(pair.difference(kRest), 1e-6 * kSize);
    EXPECT_LT(pair.difference(kTurned), 1e-6 * kSize);
}

TEST(ConvertScale, ThatIsUnevenIsNoted) {
    Scene scene;
    scene.skeleton->setName("figure");
    scene.skeleton->addChild(makeRig(blended));
    localOf(scene, 1) = osg::Matrixd::scale(1.0, 1.5, 1.0) * osg::Matrixd::translate(0, 2.4, 0);
    const ConvertReport report = convertRigs(*scene.root);
    EXPECT_EQ(report.skins.size(), 1u);
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0], "skeleton \"figure\": bone \"bone1\" in the scene and 1 more scaled "
                               "non-uniformly, mirrored or to zero, which skins do not follow");
}

TEST(ConvertScale, ThatAClipMakesUnevenIsNoted) {
    for (const bool even : {true, false}) {
        Scene scene;
        scene.skeleton->addChild(makeRig(blended));
        for (std::size_t b = 0; b < 3; ++b)
            localOf(scene, b) = osg::Matrixd::translate(0, kOffsets[b], 0);
        const osg::ref_ptr<osgAnimation::Animation> clip = new osgAnimation::Animation;
        clip->setName("stretch");
        const osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel =
            new osgAnimation::Vec3LinearChannel;
        channel->setName("scale");
        channel->setTargetName("bone2");
        auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        keys->push_back(osgAnimation::Vec3Keyframe(0.0, osg::Vec3(1, 1, 1)));
        keys->push_back(
            osgAnimation::Vec3Keyframe(1.0, even ? osg::Vec3(2, 2, 2) : osg::Vec3(1, 2, 1)));
        clip->addChannel(channel);
        const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
            new osgAnimation::BasicAnimationManager;
        manager->registerAnimation(clip);
        scene.root->setUpdateCallback(manager);
        const ConvertReport report = convertRigs(*scene.skeleton); // the manager is above it
        EXPECT_EQ(report.skins.size(), 1u);
        ASSERT_EQ(report.notes.size(), even ? 0u : 1u);
        if (!even) {
            EXPECT_NE(
                report.notes[0].find("bone \"bone2\" in the clip \"stretch\" scaled non-uniformly"),
                std::string::npos)
                << report.notes[0];
        }
    }
}

namespace {

/// A cylinder over three bones, the last one rigid, in two parts: its lower and its upper half.
struct PartedBody {
    SkinMesh mesh = shapes::cylinder();
    Binding binding;
    RigidSplit split;
    std::vector<MeshPart> parts;

    PartedBody() {
        RestSkeleton skeleton = shapes::chainAlongY({0.6, 3.0, 5.5}, 6.5);
        for (std::size_t j = 0; j < 3; ++j) skeleton.joints[j].name = "bone" + std::to_string(j);
        BindOptions options;
        options.rigid = std::vector<std::string>{"bone2"};
        binding = bind(mesh, skeleton, options);
        split = splitRigid(mesh, binding, {"bone2"});
        parts = {makePart(0.0, 3.0), makePart(3.0, 100.0)};
    }

    /// The faces whose first corner is between these heights.
    MeshPart makePart(double low, double high) const {
        MeshPart part;
        const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array,
                                           normals =
                                               new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
        for (const glm::dvec3& p : mesh.positions) {
            vertices->push_back(osg::Vec3(toOsg(p)));
            normals->push_back(osg::Vec3(0, 1, 0));
        }
        part.sourceVertex.resize(mesh.positions.size());
        std::iota(part.sourceVertex.begin(), part.sourceVertex.end(), 0u);
        const osg::ref_ptr<osg::DrawElementsUInt> elements =
            new osg::DrawElementsUInt(GL_TRIANGLES);
        std::size_t corner = 0;
        for (std::uint32_t f = 0; f < mesh.faceSizes.size(); ++f) {
            const std::uint32_t* corners = &mesh.faceVertices[corner];
            corner += mesh.faceSizes[f];
            const double height = mesh.positions[corners[0]].y;
            if (height < low || height >= high) continue;
            for (std::uint32_t k = 2; k < mesh.faceSizes[f]; ++k) {
                for (const std::uint32_t c : {corners[0], corners[k - 1], corners[k]})
                    elements->push_back(c);
                part.sourceFace.push_back(f);
            }
        }
        part.geometry = new osg::Geometry;
        part.geometry->setVertexArray(vertices);
        part.geometry->setNormalArray(normals);
        part.geometry->addPrimitiveSet(elements);
        return part;
    }
};

std::size_t triangles(const PartedBody& body) {
    return body.parts[0].sourceFace.size() + body.parts[1].sourceFace.size();
}

} // namespace

TEST(MakeSkins, NeedsNoSkeletonAndKeepsEveryFace) {
    const PartedBody body;
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    ASSERT_EQ(made.skins.size(), 2u);
    ASSERT_EQ(made.rigids.size(), 1u) << "the lower half has no rigid face";
    EXPECT_EQ(made.rigids[0].joint, "bone2");
    std::size_t faces = made.rigids[0].part.sourceFace.size();
    for (const SkinParts::Skin& skin : made.skins) {
        faces += skin.part.sourceFace.size();
        EXPECT_EQ(skin.drawable->getNumParents(), 0u);
        EXPECT_NE(skin.drawable->getUpdateCallback(), nullptr);
        const auto& model = *skin.drawable->getModel();
        ASSERT_EQ(model.vertexCount(), skin.part.sourceVertex.size());
        for (std::uint32_t v = 0; v < model.vertexCount(); ++v) {
            EXPECT_EQ(model.order()[v], v) << "not in the order of the deformation";
            EXPECT_EQ(model.positions()[v],
                      glm::vec3(body.mesh.positions[skin.part.sourceVertex[v]]));
        }
    }
    EXPECT_EQ(faces, triangles(body));
}

TEST(MakeSkins, RefusesWhatDoesNotFit) {
    const PartedBody body;
    EXPECT_THROW(makeSkins(shapes::cylinder(2.0), body.parts, body.binding, body.split), Error);
    RigidSplit shorter = body.split;
    shorter.faceJoint.pop_back();
    EXPECT_THROW(makeSkins(body.mesh, body.parts, body.binding, shorter), Error);
    RigidSplit strange = body.split;
    strange.faceJoint.back() = 3;
    EXPECT_THROW(makeSkins(body.mesh, body.parts, body.binding, strange), Error);
    std::vector<MeshPart> parts = body.parts;
    parts[1].sourceVertex.pop_back();
    EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    parts[1].geometry = nullptr;
    EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    parts[1] = body.parts[1];
    parts[1].morphs = {{"smile", 0.0f, {1000000}, {glm::vec3(1.0f)}, {}, {}}};
    EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    parts[1].morphs = {{"smile", 0.0f, {1, 2}, {glm::vec3(1.0f)}, {}, {}}};
    EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    Binding broken = body.binding;
    broken.influences[2].joint = 9;
    EXPECT_THROW(makeSkins(body.mesh, body.parts, broken, body.split), Error);
}

TEST(MakeSkins, RefusesPartsThatWouldBeReadBeyondTheirEnds) {
    const PartedBody body;
    const auto refuses = [&](void (*spoil)(MeshPart&, osg::DrawElementsUInt&)) {
        std::vector<MeshPart> parts = {body.makePart(0.0, 100.0)};
        spoil(parts[0],
              static_cast<osg::DrawElementsUInt&>(*parts[0].geometry->getPrimitiveSet(0)));
        EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    };
    refuses([](MeshPart&, osg::DrawElementsUInt& elements) { elements[4] = 1000000; });
    refuses([](MeshPart&, osg::DrawElementsUInt& elements) { elements.pop_back(); });
    refuses([](MeshPart&, osg::DrawElementsUInt& elements) { elements.resize(9); });
    refuses(
        [](MeshPart&, osg::DrawElementsUInt& elements) { elements.setMode(GL_TRIANGLE_STRIP); });
    refuses([](MeshPart& part, osg::DrawElementsUInt&) { part.sourceFace.resize(3); });
    refuses([](MeshPart& part, osg::DrawElementsUInt&) { part.geometry->setNormalArray(nullptr); });
    refuses([](MeshPart& part, osg::DrawElementsUInt&) { part.geometry->setVertexArray(nullptr); });
}

namespace {

/// Parts whose target "odd" moves every other vertex of the mesh by its index.
PartedBody morphingBody() {
    PartedBody body;
    for (MeshPart& part : body.parts) {
        MorphTarget& odd = part.morphs.emplace_back();
        odd.name = "odd";
        odd.initial = 0.5f;
        for (std::uint32_t v = 1; v < part.sourceVertex.size(); v += 2) {
            odd.vertices.push_back(v);
            odd.positions.emplace_back(float(v), 0.0f, 0.0f);
            odd.normals.emplace_back(0.0f, 0.0f, float(v));
        }
    }
    return body;
}

void expectOdd(const MorphTarget& odd, const std::vector<std::uint32_t>& source) {
    EXPECT_EQ(odd.name, "odd");
    EXPECT_EQ(odd.initial, 0.5f);
    EXPECT_EQ(odd.vertices.size(),
              std::size_t(std::count_if(source.begin(), source.end(),
                                        [](std::uint32_t v) { return v % 2 == 1; })));
    for (std::size_t i = 0; i < odd.vertices.size(); ++i) {
        const auto vertex = float(source.at(odd.vertices[i]));
        EXPECT_EQ(odd.positions[i], glm::vec3(vertex, 0.0f, 0.0f));
        EXPECT_EQ(odd.normals[i], glm::vec3(0.0f, 0.0f, vertex));
    }
}

} // namespace

TEST(MakeSkins, MorphTargetsGoWithTheirVertices) {
    const PartedBody body = morphingBody();
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    ASSERT_EQ(made.skins.size(), 2u);
    for (const SkinParts::Skin& skin : made.skins) {
        const osgSkin::MorphTargets* targets = skin.drawable->getMorphTargets();
        ASSERT_NE(targets, nullptr);
        ASSERT_EQ(targets->targets().size(), 1u);
        expectOdd(targets->targets()[0], skin.part.sourceVertex);
    }
    ASSERT_EQ(made.rigids.size(), 1u);
    ASSERT_EQ(made.rigids[0].part.morphs.size(), 1u);
    expectOdd(made.rigids[0].part.morphs[0], made.rigids[0].part.sourceVertex);
}

TEST(PlaceSkins, RigidPartsWithMorphTargetsAreSkinsAtRest) {
    const PartedBody body = morphingBody();
    rigs::Scene scene;
    const AttachedSkin placed =
        placeSkins(*scene.skeleton, makeSkins(body.mesh, body.parts, body.binding, body.split));
    ASSERT_EQ(placed.rigids.size(), 1u);
    auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(placed.rigids[0].node->getChild(0));
    ASSERT_NE(skin, nullptr);
    EXPECT_EQ(skin->getUpdateCallback(), nullptr);
    const std::vector<std::uint32_t>& source = placed.rigids[0].part.sourceVertex;
    for (const float weight : {0.5f, 0.75f}) {
        ASSERT_TRUE(skin->setMorph("odd", weight));
        const auto& drawn =
            dynamic_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
        ASSERT_EQ(drawn.size(), source.size());
        for (std::size_t v = 0; v < source.size(); ++v) {
            glm::dvec3 expected = body.mesh.positions[source[v]];
            if (source[v] % 2 == 1) expected.x += (double(weight) - 0.5) * source[v];
            EXPECT_LT((osg::Vec3d(drawn[v]) - toOsg(expected)).length(), 1e-4) << source[v];
        }
    }
}

TEST(PlaceSkins, HangsSkinsUnderTheSkeletonAndRigidPartsUnderTheirBones) {
    const PartedBody body;
    rigs::Scene scene;
    const unsigned int before = scene.skeleton->getNumChildren();
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    const AttachedSkin placed = placeSkins(*scene.skeleton, made);
    ASSERT_EQ(placed.skins.size(), 2u);
    EXPECT_EQ(scene.skeleton->getNumChildren(), before + 2);
    for (unsigned int i = 0; i < 2; ++i)
        EXPECT_EQ(scene.skeleton->getChild(before + i), placed.skins[i].drawable.get());
    ASSERT_EQ(placed.rigids.size(), 1u);
    EXPECT_EQ(placed.rigids[0].bone, scene.bones[2]);
    EXPECT_TRUE(scene.bones[2]->containsNode(placed.rigids[0].node));
}

/// Such as a rider's, with bones of the same names.
TEST(PlaceSkins, LeavesASkeletonBelowAsItIs) {
    const PartedBody body;
    rigs::Scene scene, rider;
    scene.bones[2]->addChild(rider.skeleton);
    const AttachedSkin placed =
        placeSkins(*scene.skeleton, makeSkins(body.mesh, body.parts, body.binding, body.split));
    ASSERT_EQ(placed.rigids.size(), 1u);
    EXPECT_EQ(placed.rigids[0].bone, scene.bones[2]);
}

TEST(PlaceSkins, WithoutTheRigidPartsBonePlacesNothing) {
    const PartedBody body;
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    EXPECT_THROW(placeSkins(*skeleton, made), Error);
    EXPECT_EQ(skeleton->getNumChildren(), 0u);
    EXPECT_EQ(made.skins[0].drawable->getNumParents(), 0u);
}
