// SPDX-License-Identifier: MIT
// Scenes that OSG reads from files but that it or osgAnimation could not draw or update safely.
#include "osg/CheckScene.h"
#include "ExpectError.h"

#include <osgSkinImport/ReadScene>

#include <osg/Geometry>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>
#include <osgAnimation/UpdateMatrixTransform>
#include <osgDB/WriteFile>
#include <osgUtil/UpdateVisitor>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace {

using osgAnimation::MorphGeometry;
using osgAnimation::RigGeometry;
using osgAnimation::VertexInfluenceMap;

const char* const kSavedFormats[] = {"osgt", "osgb", "osgx"};

/// Triangles with normals, as many as fit into the number of vertices.
osg::ref_ptr<osg::Geometry> makeTriangles(unsigned vertices = 3) {
    osg::ref_ptr<osg::Geometry> result = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    for (unsigned v = 0; v < vertices; ++v) places->push_back({float(v), float(v % 2), 0.0f});
    result->setVertexArray(places);
    result->setNormalArray(new osg::Vec3Array(vertices), osg::Array::BIND_PER_VERTEX);
    result->addPrimitiveSet(
        new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices / 3 * 3)));
    return result;
}

/// Saves the scene in each format, reads it and updates it.
void expectMoved(osg::Node& scene, const std::string& message) {
    for (const char* format : kSavedFormats) {
        SCOPED_TRACE(format);
        const std::string path = testing::TempDir() + "deformed." + format;
        ASSERT_TRUE(osgDB::writeNodeFile(scene, path));
        if (!message.empty()) {
            expectError([&] { osgSkin::readScene(path, nullptr); }, message);
            continue;
        }
        const osg::ref_ptr<osg::Node> read = osgSkin::readScene(path, nullptr);
        ASSERT_TRUE(read.valid());
        osgUtil::UpdateVisitor update;
        const osg::ref_ptr<osg::FrameStamp> frame = new osg::FrameStamp;
        update.setFrameStamp(frame);
        read->accept(update);
    }
}

void expectRig(const std::function<void(RigGeometry&)>& change, const std::string& message) {
    const osg::ref_ptr<RigGeometry> rig = new RigGeometry;
    rig->setSourceGeometry(makeTriangles());
    const osg::ref_ptr<VertexInfluenceMap> influences = new VertexInfluenceMap;
    osgAnimation::VertexInfluence& influence = (*influences)["bone"];
    influence.setName("bone");
    for (unsigned v = 0; v < 3; ++v) influence.push_back({v, 1.0f});
    rig->setInfluenceMap(influences);
    rig->setUpdateCallback(new osgAnimation::UpdateRigGeometry);
    rig->setDataVariance(osg::Object::DYNAMIC);
    change(*rig);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setDefaultUpdateCallback();
    const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("bone");
    bone->setDefaultUpdateCallback();
    skeleton->addChild(bone);
    skeleton->addChild(rig);
    expectMoved(*skeleton, message);
}

void expectMorph(const osg::ref_ptr<osg::Geometry>& base, const osg::ref_ptr<osg::Geometry>& target,
                 const std::string& message) {
    const osg::ref_ptr<MorphGeometry> morph = new MorphGeometry(*base);
    morph->addMorphTarget(target, 0.5f);
    morph->setUpdateCallback(new osgAnimation::UpdateMorphGeometry);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(morph);
    expectMoved(*scene, message);
}

} // namespace

TEST(CheckScene, RejectsRigsWithInvalidWeights) {
    expectRig([](RigGeometry&) {}, "");
    for (const unsigned beyond : {3u, 70'000u, 999'999'999u})
        expectRig(
            [&](RigGeometry& rig) {
                (*rig.getInfluenceMap())["bone"].push_back({beyond, 1.0f});
            },
            "bone \"bone\": weight of vertex " + std::to_string(beyond) +
                ", expected a vertex below 3 and a number of 0 or more, up to 1e18");
    for (const float wrong : {-1.0f, -1e38f, 1e38f})
        expectRig(
            [&](RigGeometry& rig) {
                (*rig.getInfluenceMap())["bone"].push_back({1, wrong});
            },
            "bone \"bone\": weight of vertex 1, expected a vertex below 3 and a number");
    expectRig(
        [](RigGeometry& rig) {
            (*rig.getInfluenceMap())["bone"].push_back({1, -1e-8f});
        },
        "");
    expectRig([](RigGeometry& rig) { rig.setSourceGeometry(nullptr); }, "no source geometry");
    expectRig([](RigGeometry& rig) { rig.setSourceGeometry(new osg::Geometry); },
              "weight of vertex 0, expected a vertex below 0");
    expectRig([](RigGeometry& rig) { rig.setInfluenceMap(new VertexInfluenceMap); }, "no bones");
}

TEST(CheckScene, RejectsMorphsOfOtherSize) {
    expectMorph(makeTriangles(), makeTriangles(), "");
    // Nothing at rest yet, as before the first update.
    const osg::ref_ptr<MorphGeometry> fresh = new MorphGeometry(*makeTriangles());
    fresh->addMorphTarget(makeTriangles(), 0.5f);
    fresh->setVertexSource(new osg::Vec3Array);
    fresh->setNormalSource(new osg::Vec3Array);
    fresh->setUpdateCallback(new osgAnimation::UpdateMorphGeometry);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(fresh);
    expectMoved(*scene, "");
    expectMorph(makeTriangles(), makeTriangles(9), "9 vertices of a morph target, expected 3");
    expectMorph(makeTriangles(9), makeTriangles(3), "3 vertices of a morph target, expected 9");
    const auto withPlaces = [](osg::Array* places) {
        osg::ref_ptr<osg::Geometry> result = makeTriangles();
        result->setVertexArray(places);
        return result;
    };
    const auto withNormals = [](osg::Array* normals, osg::Array::Binding binding) {
        osg::ref_ptr<osg::Geometry> result = makeTriangles();
        result->setNormalArray(normals, binding);
        return result;
    };
    expectMorph(withPlaces(new osg::Vec3dArray(3)), makeTriangles(),
                "vertices that are not of three floats each");
    expectMorph(makeTriangles(), withPlaces(new osg::FloatArray(3)),
                "vertices of a morph target that are not of three floats each");
    expectMorph(withNormals(new osg::FloatArray(3), osg::Array::BIND_PER_VERTEX), makeTriangles(),
                "normals that are not of three floats each");
    const auto one = withNormals(new osg::Vec3Array(1), osg::Array::BIND_OVERALL);
    expectMorph(one, makeTriangles(), "1 normals, expected 3");
    expectMorph(makeTriangles(), one, "1 normals of a morph target, expected 3");
}

TEST(CheckScene, RejectsBoneMatricesOutOfRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const char* format : kSavedFormats)
        for (const double number : {0.5, 1e19, nan})
            for (int where = 0; where < 2; ++where) {
                // OSG cannot read such a number from text.
                if (std::isnan(number) && format != kSavedFormats[1]) continue;
                const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("bone");
                const osg::ref_ptr<osgAnimation::UpdateBone> update =
                    new osgAnimation::UpdateBone("bone");
                const float moved = where == 0 ? float(number) : 0.0f;
                update->getStackedTransforms().push_back(
                    new osgAnimation::StackedTranslateElement("translate", {moved, 0, 0}));
                bone->setUpdateCallback(update);
                if (where == 1)
                    bone->setInvBindMatrixInSkeletonSpace(osg::Matrixd::translate(number, 0, 0));
                const osg::ref_ptr<osgAnimation::Skeleton> scene = new osgAnimation::Skeleton;
                scene->setDefaultUpdateCallback();
                scene->addChild(bone);
                SCOPED_TRACE(std::string(format) + std::to_string(where) + std::to_string(number));
                const std::string path = testing::TempDir() + "places." + format;
                ASSERT_TRUE(osgDB::writeNodeFile(*scene, path));
                if (number < 1.0)
                    EXPECT_NE(osgSkin::readScene(path, nullptr), nullptr);
                else
                    expectError([&] { osgSkin::readScene(path, nullptr); }, path);
            }
}

TEST(CheckScene, RejectsVerticesAndPrimitivesOutOfRange) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float far : {0.5f, 1e30f, nan}) {
        const osg::ref_ptr<osg::Geometry> geometry = makeTriangles();
        static_cast<osg::Vec3Array&>(*geometry->getVertexArray())[1].x() = far;
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        for (int i = 0; i < 2; ++i) scene->addChild(geometry);
        if (far < 1.0f)
            osgSkin::checkScene(*scene, "scene");
        else
            expectError([&] { osgSkin::checkScene(*scene, "scene"); },
                        "vertices that are not finite, or beyond -1e18 to 1e18");
    }
    const auto withSet = [](osg::PrimitiveSet* set) {
        osg::ref_ptr<osg::Geometry> geometry = makeTriangles();
        geometry->setPrimitiveSet(0, set);
        return geometry;
    };
    const GLuint far[] = {0, 1, 3}, half[] = {0, 1};
    const auto one = [&](osg::PrimitiveSet* set, const std::string& message) {
        const osg::ref_ptr<osg::Geometry> geometry = withSet(set);
        expectError([&] { osgSkin::checkScene(*geometry, "scene"); }, message);
    };
    one(new osg::DrawElementsUInt(GL_TRIANGLES, 3, far), "names vertex 3, expected less than 3");
    one(new osg::DrawElementsUInt(GL_TRIANGLES, 2, half), "a multiple of 3");
    one(new osg::DrawArrays(GL_TRIANGLES, 0, 6), "expected less than 3");
    one(new osg::DrawArrays(GL_TRIANGLES, -1, 3), "expected less than 3");
    const osg::ref_ptr<osg::Geometry> few = makeTriangles();
    few->setTexCoordArray(0, new osg::Vec2Array(2), osg::Array::BIND_PER_VERTEX);
    expectError([&] { osgSkin::checkScene(*few, "scene"); }, "an array of 2 elements");
    const osg::ref_ptr<osg::MatrixTransform> away =
        new osg::MatrixTransform(osg::Matrix::translate(1e39, 0, 0));
    expectError([&] { osgSkin::checkScene(*away, "scene"); },
                "a matrix with numbers that are not finite");
}

TEST(CheckScene, RejectsRigBoxCallbackOnPlainGeometry) {
    const osg::ref_ptr<osg::Geometry> plain = makeTriangles();
    plain->setComputeBoundingBoxCallback(new osgAnimation::RigComputeBoundingBoxCallback);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(plain);
    for (const char* format : kSavedFormats) {
        const std::string path = testing::TempDir() + "box." + format;
        ASSERT_TRUE(osgDB::writeNodeFile(*scene, path));
        expectError([&] { osgSkin::readScene(path, nullptr); },
                    "has the bounding box callback of a rig");
    }
}

TEST(CheckScene, RejectsChannelTypeMismatch) {
    for (const bool fits : {true, false}) {
        const osg::ref_ptr<osgAnimation::UpdateMatrixTransform> update =
            new osgAnimation::UpdateMatrixTransform("thing");
        if (fits)
            update->getStackedTransforms().push_back(
                new osgAnimation::StackedQuaternionElement("turn", osg::Quat()));
        else
            update->getStackedTransforms().push_back(
                new osgAnimation::StackedTranslateElement("turn", osg::Vec3()));
        const osg::ref_ptr<osg::MatrixTransform> thing = new osg::MatrixTransform;
        thing->setUpdateCallback(update);
        const osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
            new osgAnimation::QuatSphericalLinearChannel;
        channel->setName("turn");
        channel->setTargetName("thing");
        auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        keys->push_back(osgAnimation::QuatKeyframe(0.0, osg::Quat()));
        keys->push_back(osgAnimation::QuatKeyframe(1.0, osg::Quat(0, 0, 1, 0)));
        const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
        animation->setName("clip");
        animation->addChannel(channel);
        const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
            new osgAnimation::BasicAnimationManager;
        manager->registerAnimation(animation);
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->setUpdateCallback(manager);
        scene->addChild(thing);
        expectMoved(*scene, fits ? ""
                                 : "animation \"clip\": channel \"turn\" of \"thing\" does "
                                   "not match the type of its target");
    }
}

// OSG divides by an animation's length, and reads beyond a pose's only key then.
TEST(CheckScene, RejectsInfiniteDurations) {
    using osgAnimation::Animation;
    for (const double duration : {0.0, 2.0, double(NAN), double(INFINITY)}) {
        const osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel =
            new osgAnimation::Vec3LinearChannel;
        channel->setName("translate");
        channel->setTargetName("thing");
        channel->getOrCreateSampler()->getOrCreateKeyframeContainer()->push_back(
            osgAnimation::Vec3Keyframe(0.0, osg::Vec3(1, 2, 3)));
        const osg::ref_ptr<Animation> animation = new Animation;
        animation->setName("pose");
        animation->addChannel(channel);
        animation->setPlayMode(Animation::STAY);
        if (duration != 0.0) animation->setDuration(duration);
        const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
            new osgAnimation::BasicAnimationManager;
        manager->registerAnimation(animation);
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->setUpdateCallback(manager);
        const std::string path = testing::TempDir() + "pose.osgb";
        ASSERT_TRUE(osgDB::writeNodeFile(*scene, path));
        if (!std::isfinite(duration)) {
            expectError([&] { osgSkin::readScene(path, nullptr); },
                        "animation \"pose\" has a duration or a start that is not finite");
            continue;
        }
        const osg::ref_ptr<osg::Node> read = osgSkin::readScene(path, nullptr);
        auto* player =
            dynamic_cast<osgAnimation::BasicAnimationManager*>(read->getUpdateCallback());
        ASSERT_NE(player, nullptr);
        EXPECT_EQ(player->getAnimationList().front()->getPlayMode(), Animation::LOOP);
    }
}
