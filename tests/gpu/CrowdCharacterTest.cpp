// SPDX-License-Identifier: MIT
//
// Crowds made of a loaded character in one call.
#include "CrowdPicture.h"
#include "FindNodes.h"
#include "GpuStage.h"
#include "Pixels.h"

#include <osgSkin/Error>
#include <osgSkin/RigidPart>
#include <osgSkinMotion/ClipCharacter>

#include <gtest/gtest.h>
#include <osg/GLExtensions>
#include <osgAnimation/BasicAnimationManager>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <sstream>

namespace {

using osgSkin::CrowdCharacter;
using osgSkin::CrowdInstance;
using osgSkin::GpuCrowd;
using test::CrowdSubject;
using test::GpuStage;

/// The thrower with three clips, of different lengths.
osg::ref_ptr<osg::Node> loadThrower() {
    osg::ref_ptr<osg::Node> scene =
        osgDB::readRefNodeFile(std::string(OSGSKIN_DATA) + "/thrower.skin");
    for (const auto& found : test::findNodes<osg::Node>(*scene)) {
        auto* manager =
            dynamic_cast<osgAnimation::AnimationManagerBase*>(found.node->getUpdateCallback());
        if (!manager || manager->getAnimationList().empty()) continue;
        osgAnimation::Animation& first = *manager->getAnimationList().front();
        first.setName("walk");
        for (const char* name : {"run", "jump"}) {
            const osg::ref_ptr<osgAnimation::Animation> next =
                osg::clone(&first, osg::CopyOp::DEEP_COPY_ALL);
            next->setName(name);
            next->setDuration(name[0] == 'r' ? 0.5 : 0.25);
            manager->registerAnimation(next);
        }
        manager->getAnimationList().back()->setPlayMode(osgAnimation::Animation::ONCE);
        return scene;
    }
    throw std::runtime_error("the thrower has no animation");
}

osg::ref_ptr<osg::Node> savedAndReadAgain(osg::Node& scene) {
    osgDB::ReaderWriter* osgb = osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
    std::stringstream bytes;
    if (!osgb->writeNode(scene, bytes).success()) throw std::runtime_error("not written");
    return osgb->readNode(bytes).takeNode();
}

osg::ref_ptr<osg::Group> inProgram(osg::Node* node) {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(node);
    root->getOrCreateStateSet()->setAttribute(
        CrowdSubject::program(), osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    return root;
}

osg::ref_ptr<osg::Image> pictureOf(osg::Node* scene, const osg::BoundingSphere& sphere) {
    GpuStage stage(scene);
    stage.setSphere(sphere);
    stage.look({0.4, -1.0, 0.6}, 2.2);
    stage.draw();
    osg::ref_ptr<osg::Image> picture = new osg::Image(stage.picture(), osg::CopyOp::DEEP_COPY_ALL);
    scene->releaseGLObjects(nullptr);
    return picture;
}

/// Counts the triangles that a camera draws.
struct CountTriangles {
    static constexpr GLenum kPrimitivesGenerated = 0x8C87;

    struct Begin : osg::Camera::DrawCallback {
        explicit Begin(GLuint& name) : query(name) {}
        void operator()(osg::RenderInfo& info) const override {
            const osg::GLExtensions& gl = *info.getState()->get<osg::GLExtensions>();
            if (query == 0) gl.glGenQueries(1, &query);
            gl.glBeginQuery(kPrimitivesGenerated, query);
        }
        GLuint& query;
    };
    struct End : osg::Camera::DrawCallback {
        End(GLuint& name, GLuint& count) : query(name), triangles(count) {}
        void operator()(osg::RenderInfo& info) const override {
            const osg::GLExtensions& gl = *info.getState()->get<osg::GLExtensions>();
            gl.glEndQuery(kPrimitivesGenerated);
            gl.glGetQueryObjectuiv(query, GL_QUERY_RESULT_ARB, &triangles);
        }
        GLuint &query, &triangles;
    };

    explicit CountTriangles(osg::Camera& camera) {
        camera.setPreDrawCallback(new Begin(query));
        camera.setPostDrawCallback(new End(query, triangles));
    }
    GLuint query = 0, triangles = 0;
};

} // namespace

TEST(CrowdOfALoadedCharacter, FindsClipsByName) {
    const osg::ref_ptr<osg::Node> loaded = loadThrower();
    for (const osg::ref_ptr<osg::Node>& node : {loaded, savedAndReadAgain(*loaded)}) {
        const auto character = CrowdCharacter::create(*node);
        ASSERT_EQ(character->clipCount(), 3u);
        EXPECT_EQ(character->clip("walk"), 0u);
        EXPECT_EQ(character->clip("jump"), 2u);
        EXPECT_EQ(character->clipName(1), "run");
        EXPECT_NEAR(character->loopSeconds(1), 0.5, 1e-6);
        EXPECT_EQ(character->loopSeconds(2), 0.0) << "played once";
        EXPECT_EQ(character->parts().size(), 1 + test::findNodes<osgSkin::RigidPart>(*node).size());
        try {
            character->clip("swim");
            ADD_FAILURE() << "expected an error";
        } catch (const osgSkin::Error& error) {
            EXPECT_STREQ(error.what(),
                         "crowd: no clip \"swim\", expected one of \"walk\", \"run\", \"jump\"");
        }
    }
}

TEST(CrowdOfALoadedCharacter, MatchesPictureOfItsCopies) {
    const osg::ref_ptr<osg::Node> loaded = loadThrower();
    const auto character = CrowdCharacter::create(*loaded);
    const auto copies = osgSkin::ClipCharacter::create(*loaded);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    std::vector<CrowdInstance> members(4);
    for (std::size_t i = 0; i < members.size(); ++i) {
        const auto clip = copies->clip(i % 2 == 0 ? "walk" : "run");
        CrowdInstance& member = members[i];
        member.position = osg::Vec3d(double(i % 2), double(i / 2), 0.0);
        member.rotation = osg::Quat(0.5 * double(i), osg::Vec3d(0, 0, 1));
        member.clip = character->clip(clip->name());
        member.phase = 5.0 * double(i) * clip->step();
        const auto copy = copies->makeInstance(false);
        copy.player->setLayer(0, {clip, member.phase});
        ASSERT_TRUE(copy.player->pose());
        copy.node->setMatrix(osg::Matrixd::rotate(member.rotation) *
                             osg::Matrixd::translate(member.position));
        scene->addChild(copy.node);
    }
    const osg::ref_ptr<GpuCrowd> crowd = new GpuCrowd(character);
    crowd->setInstances(members);
    const osg::BoundingSphere sphere = scene->getBound();
    const auto expected = pictureOf(inProgram(scene), sphere);
    EXPECT_GT(test::seenPixels(*expected), 10000u);
    EXPECT_LE(test::unlikePixels(*pictureOf(inProgram(crowd), sphere), *expected), 40u);
}

TEST(CrowdOfALoadedCharacter, OmitsHiddenPartsAndMovesNestedParts) {
    const osg::ref_ptr<osg::Node> loaded = loadThrower();
    const auto all = CrowdCharacter::create(*loaded);
    osgSkin::RigidPart& part = *test::findNodes<osgSkin::RigidPart>(*loaded).at(0).node;
    // A sword that the part holds under a transform of its own.
    const osg::ref_ptr<osg::Geometry> sword =
        osg::clone(part.getChild(0)->asGeometry(), osg::CopyOp::SHALLOW_COPY);
    const osg::ref_ptr<osg::MatrixTransform> grip =
        new osg::MatrixTransform(osg::Matrixd::translate(0.0, 100.0, 0.0));
    grip->addChild(sword);
    part.addChild(grip);
    const auto armed = CrowdCharacter::create(*loaded);
    EXPECT_EQ(armed->parts().size(), all->parts().size() + 1);
    EXPECT_GT((armed->bounds().zMax() - all->bounds().zMax()) +
                  (armed->bounds().yMax() - all->bounds().yMax()),
              0.1f);
    part.setNodeMask(0);
    EXPECT_EQ(CrowdCharacter::create(*loaded)->parts().size(), all->parts().size() - 1);
}

TEST(CrowdOfALoadedCharacter, DrawsAtMostSixtyTrianglesOfDistantMembers) {
    const auto character = CrowdCharacter::create(*loadThrower());
    EXPECT_GT(character->levelCount(), 3u);
    EXPECT_LE(character->triangleCount(character->levelCount() - 1), CrowdCharacter::kFarTriangles);
    EXPECT_GT(character->triangleCount(character->levelCount() - 1), 30u);
    std::vector<CrowdInstance> members(100000);
    for (std::size_t i = 0; i < members.size(); ++i) {
        members[i].position = osg::Vec3d(double(i % 316), double(i / 316), 0.0);
        members[i].phase = 0.01 * double(i);
    }
    const osg::ref_ptr<GpuCrowd> crowd = new GpuCrowd(character);
    crowd->setInstances(members);
    GpuStage stage(crowd);
    stage.look({0.0, -1.0, 0.8}, 3.0);
    stage.frame(0.0);
    const CountTriangles count(*stage.viewer.getView(0)->getCamera());
    stage.frame(0.0);
    EXPECT_GT(test::seenPixels(stage.picture()), 10000u);
    EXPECT_LE(count.triangles, members.size() * CrowdCharacter::kFarTriangles);
    EXPECT_GT(count.triangles, members.size() * 30);
    crowd->releaseGLObjects(nullptr);
}
