// SPDX-License-Identifier: MIT
// A skin's drawn geometry: two buffers, filled alternately, with everything that the rest geometry
// has.
#include "SomeCorrectives.h"
#include "TubeSkin.h"

#include <osgSkin/DeformPool>
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>

#include <gtest/gtest.h>
#include <osg/Point>
#include <osg/TriangleFunctor>
#include <osgUtil/Optimizer>

#include <cmath>

using test::bend;
using test::cull;
using test::makeBones;
using test::makeGeometry;
using test::makeSkin;
using test::verticesOf;

namespace {

struct Count {
    unsigned int triangles = 0;
    void operator()(const osg::Vec3&, const osg::Vec3&, const osg::Vec3&, bool = false) {
        ++triangles;
    }
};

struct OpenSkin : osgSkin::DeformableSkin {
    bool isBounded() const { return _boundingSphereComputed; }
};

} // namespace

TEST(DeformableSkin, DefaultIsEmpty) {
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    EXPECT_EQ(skin->getDeformedGeometry(), nullptr);
    EXPECT_FALSE(skin->setPose(std::vector<osg::Matrixd>()));
    EXPECT_FALSE(skin->getBoundingBox().valid());
    cull(*skin, true);
    osg::TriangleFunctor<Count> count;
    skin->accept(count);
    EXPECT_EQ(count.triangles, 0u);
}

TEST(DeformableSkin, RejectsMismatchedGeometry) {
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    EXPECT_THROW(skin->setSkin(nullptr, test::Tube().model()), osgSkin::Error);
    EXPECT_THROW(skin->setSkin(makeGeometry(test::Tube()), nullptr), osgSkin::Error);
    EXPECT_THROW(skin->setSkin(makeGeometry(test::Tube(9)), test::Tube().model()), osgSkin::Error);
    // Picking would read out of bounds of the vertices, or of the indices.
    for (const std::vector<GLuint>& corners : {std::vector<GLuint>{0, 1, 1000000}, {0, 1, 2, 3}}) {
        const osg::ref_ptr<osg::Geometry> broken = makeGeometry(test::Tube());
        broken->addPrimitiveSet(
            new osg::DrawElementsUInt(GL_TRIANGLES, corners.begin(), corners.end()));
        EXPECT_THROW(skin->setSkin(broken, test::Tube().model()), osgSkin::Error);
    }
    // A driver would read out of bounds of an array, and a saved skin would be refused.
    for (const auto binding : {osg::Array::BIND_PER_VERTEX, osg::Array::BIND_OVERALL}) {
        const osg::ref_ptr<osg::Geometry> lacking = makeGeometry(test::Tube());
        lacking->setTexCoordArray(0, new osg::Vec2Array(3), binding);
        if (binding == osg::Array::BIND_PER_VERTEX)
            EXPECT_THROW(skin->setSkin(lacking, test::Tube().model()), osgSkin::Error);
        else
            EXPECT_NO_THROW(osg::ref_ptr<osgSkin::DeformableSkin>(new osgSkin::DeformableSkin)
                                ->setSkin(lacking, test::Tube().model()));
    }
    EXPECT_EQ(skin->getModel(), nullptr);
}

TEST(DeformableSkin, DeformsOncePerPoseAndOnlyInView) {
    const auto skin = makeSkin();
    bend(*skin, 0.3);
    EXPECT_EQ(skin->getDeformCount(), 0u);
    cull(*skin, false);
    EXPECT_EQ(skin->getDeformCount(), 0u);
    cull(*skin, true);
    cull(*skin, true);
    cull(*skin, true);
    EXPECT_EQ(skin->getDeformCount(), 1u);
    bend(*skin, 0.4);
    cull(*skin, true);
    EXPECT_EQ(skin->getDeformCount(), 2u);
}

TEST(DeformableSkin, EagerSkinDeformsImmediately) {
    const auto skin = makeSkin();
    skin->setEager(true);
    bend(*skin, 0.3);
    EXPECT_EQ(skin->getDeformCount(), 1u);
}

TEST(DeformableSkin, BoundsFollowThePose) {
    const auto skin = makeSkin();
    EXPECT_TRUE(skin->getBoundingBox().contains({0, 5.9f, 0}));
    bend(*skin, osg::PI_2);
    EXPECT_FALSE(skin->getBoundingBox().contains({0, 5.9f, 0}));
    EXPECT_TRUE(skin->getBoundingBox().contains({0, 2, 3.9f}));
}

/// Otherwise cull threads that start together would compute it at the same time.
TEST(DeformableSkin, ComputesItsBoundWhenPosed) {
    const osg::ref_ptr<osgSkin::DeformableSkin> of = makeSkin();
    const osg::ref_ptr<OpenSkin> skin = new OpenSkin;
    skin->setSkin(new osg::Geometry(*of->getRestGeometry()), of->getModel());
    EXPECT_TRUE(skin->isBounded());
    bend(*skin, 0.7);
    EXPECT_TRUE(skin->isBounded());
}

TEST(DeformableSkin, CopiesShareTheModelButNotThePose) {
    const auto skin = makeSkin();
    bend(*skin, 0.5);
    const osg::ref_ptr<osgSkin::DeformableSkin> copy =
        osg::clone(skin.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_EQ(copy->getModel(), skin->getModel());
    const std::vector<osg::Vec3> before = verticesOf(*copy);
    bend(*skin, 1.0);
    skin->getDeformedGeometry();
    EXPECT_EQ(verticesOf(*copy), before);
}

TEST(DeformableSkin, OptimizerDoesNotChangeIt) {
    const osg::ref_ptr<osg::MatrixTransform> scene =
        new osg::MatrixTransform(osg::Matrix::translate(10, 0, 0));
    scene->setDataVariance(osg::Object::STATIC);
    scene->addChild(makeSkin());
    scene->addChild(makeSkin());
    osgUtil::Optimizer().optimize(scene, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    ASSERT_EQ(scene->getNumChildren(), 2u);
    for (unsigned int i = 0; i < 2; ++i) {
        const auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(scene->getChild(i));
        ASSERT_NE(skin, nullptr);
        const auto& rest =
            static_cast<const osg::Vec3Array&>(*skin->getRestGeometry()->getVertexArray());
        EXPECT_EQ(rest.front(), osg::Vec3(1, 0, 0));
    }
}

TEST(DeformableSkin, DeformsByItsActivations) {
    test::Tube tube;
    tube.binding.correctives = test::someCorrectives(tube.binding, 0.3, 5);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    EXPECT_FALSE(skin->setActivation("breath", 1.0f)); // no skin yet
    skin->setSkin(makeGeometry(tube), tube.model());
    const auto atRest = verticesOf(*skin);
    EXPECT_EQ(skin->getActivation("breath"), 0.0f);
    EXPECT_FALSE(skin->setActivation("Breath", 1.0f));
    EXPECT_FALSE(skin->setActivation("breath", std::nanf("")));
    EXPECT_FALSE(skin->needsDeform());
    EXPECT_TRUE(skin->setActivation("breath", 0.5f));
    EXPECT_EQ(skin->getActivation("breath"), 0.5f);
    EXPECT_TRUE(skin->needsDeform());
    EXPECT_NE(verticesOf(*skin), atRest);
    EXPECT_TRUE(skin->setActivation("breath", 0.5f)); // the same value causes no work
    EXPECT_FALSE(skin->needsDeform());
    // The pose changes independently, and copies keep it.
    bend(*skin, 0.3);
    EXPECT_EQ(skin->getActivation("breath"), 0.5f);
    const osg::ref_ptr<osgSkin::DeformableSkin> copy = new osgSkin::DeformableSkin(*skin);
    EXPECT_EQ(verticesOf(*copy), verticesOf(*skin));
    EXPECT_TRUE(copy->setActivation("breath", 0.0f));
    EXPECT_EQ(skin->getActivation("breath"), 0.5f);
    // Another geometry of the same skin has the same activation.
    skin->setSkin(makeGeometry(tube), tube.model());
    EXPECT_EQ(skin->getActivation("breath"), 0.5f);
    EXPECT_NE(verticesOf(*skin), atRest);
}

namespace {

constexpr unsigned int kTangents = 6;

/// The tube with tangents, texture coordinates, colours, another attribute and two primitive sets.
osg::ref_ptr<osg::Geometry> makeRich() {
    const test::Tube tube;
    osg::ref_ptr<osg::Geometry> geometry = test::makeGeometry(tube);
    const auto count = static_cast<unsigned int>(tube.positions.size());
    const osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array;
    for (unsigned int v = 0; v < count; ++v)
        tangents->push_back(osg::Vec4(0, 1, 0, v % 2 == 0 ? 1.0f : -1.0f));
    geometry->setVertexAttribArray(kTangents, tangents, osg::Array::BIND_PER_VERTEX);
    geometry->setVertexAttribArray(7, new osg::FloatArray(count), osg::Array::BIND_PER_VERTEX);
    geometry->setTexCoordArray(0, new osg::Vec2Array(count), osg::Array::BIND_PER_VERTEX);
    geometry->setTexCoordArray(2, new osg::Vec3Array(count), osg::Array::BIND_PER_VERTEX);
    geometry->setColorArray(new osg::Vec4Array(1), osg::Array::BIND_OVERALL);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 12));
    return geometry;
}

osg::ref_ptr<osgSkin::DeformableSkin> makeRichSkin() {
    osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setTangentAttribute(kTangents);
    skin->setSkin(makeRich(), test::Tube().model());
    return skin;
}

} // namespace

TEST(SkinBuffers, AlternateBetweenFrames) {
    const auto skin = test::makeSkin();
    std::vector<const osg::Geometry*> drawn;
    for (int frame = 1; frame <= 3; ++frame) {
        test::bend(*skin, 0.3 * frame);
        test::cull(*skin, true);
        drawn.push_back(skin->getDeformedGeometry());
    }
    EXPECT_NE(drawn[0], drawn[1]);
    EXPECT_EQ(drawn[0], drawn[2]);
    EXPECT_NE(drawn[0]->getVertexArray()->getVertexBufferObject(),
              drawn[1]->getVertexArray()->getVertexBufferObject());
}

// A pose that is read and replaced within a frame must not change the buffer that a draw thread is
// still reading.
TEST(SkinBuffers, DoNotOverwriteTheBufferBeingDrawn) {
    const auto skin = test::makeSkin();
    test::bend(*skin, 0.3);
    test::cull(*skin, true);
    const osg::Geometry* drawn = skin->getDeformedGeometry();
    const auto vertices = static_cast<const osg::Vec3Array*>(drawn->getVertexArray())->asVector();
    for (const double angle : {0.5, 0.7, 0.9}) {
        test::bend(*skin, angle);
        EXPECT_NE(skin->getDeformedGeometry(), drawn);
    }
    test::cull(*skin, true);
    EXPECT_EQ(static_cast<const osg::Vec3Array*>(drawn->getVertexArray())->asVector(), vertices);
}

TEST(SkinBuffers, AreKeptWhileThePoseIsTheSame) {
    const auto skin = test::makeSkin();
    for (int frame = 0; frame < 5; ++frame) {
        test::bend(*skin, 0.3);
        test::cull(*skin, true);
    }
    EXPECT_EQ(skin->getDeformCount(), 1u);
    EXPECT_DOUBLE_EQ(skin->getPose().transform(1).split.bendAngle, 0.3);
}

TEST(SkinBuffers, AreNotDynamic) {
    const auto skin = test::makeSkin();
    EXPECT_NE(skin->getDeformedGeometry()->getDataVariance(), osg::Object::DYNAMIC);
    EXPECT_FALSE(skin->getDeformedGeometry()->getUseDisplayList());
}

TEST(SkinBuffers, FollowVertexBufferSettings) {
    const auto skin = test::makeSkin();
    EXPECT_TRUE(skin->getDeformedGeometry()->getUseVertexBufferObjects());
    skin->setUseDisplayList(true);
    EXPECT_FALSE(skin->getUseDisplayList());
    skin->setUseVertexBufferObjects(false);
    EXPECT_FALSE(skin->getDeformedGeometry()->getUseVertexBufferObjects());
    const osg::ref_ptr<osgSkin::DeformableSkin> copy = osg::clone(skin.get());
    EXPECT_FALSE(copy->getDeformedGeometry()->getUseVertexBufferObjects());
    skin->setUseVertexArrayObject(true);
    test::bend(*skin, 0.4);
    EXPECT_TRUE(skin->getDeformedGeometry()->getUseVertexArrayObject());
}

/// Other skins may be drawing right now with buffers that one skin releases.
TEST(SkinBuffers, DoNotReleaseSharedObjects) {
    static int releases;
    releases = 0;
    struct Counted : osg::Point {
        void releaseGLObjects(osg::State*) const override { ++releases; }
    };
    struct CountedBuffer : osg::VertexBufferObject {
        void releaseGLObjects(osg::State*) const override { ++releases; }
    };
    const osg::ref_ptr<osg::Geometry> rest = makeRich();
    rest->getOrCreateStateSet()->setAttribute(new Counted);
    const osg::ref_ptr<CountedBuffer> shared = new CountedBuffer;
    rest->getTexCoordArray(0)->setVertexBufferObject(shared);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(rest, test::Tube().model());
    osg::ref_ptr<osgSkin::DeformableSkin> copy = osg::clone(skin.get());
    copy->setTangentAttribute(kTangents);
    copy->setSkin(rest, test::Tube().model());
    copy = nullptr;
    EXPECT_EQ(releases, 0);
    skin->releaseGLObjects(nullptr); // explicitly
    EXPECT_GT(releases, 0);
}

TEST(SkinBuffers, UseTheDrawCallback) {
    struct Nothing : osg::Drawable::DrawCallback {};
    const osg::ref_ptr<Nothing> callback = new Nothing, ofRest = new Nothing;
    const osg::ref_ptr<osg::Geometry> rest = makeRich();
    rest->setDrawCallback(ofRest);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setDrawCallback(callback); // before the skin, too
    skin->setSkin(rest, test::Tube().model());
    EXPECT_EQ(skin->getDeformedGeometry()->getDrawCallback(), callback);
    skin->setDrawCallback(nullptr);
    EXPECT_EQ(skin->getDeformedGeometry()->getDrawCallback(), ofRest);
    skin->setDrawCallback(callback); // and without a later pose
    EXPECT_EQ(skin->getDeformedGeometry()->getDrawCallback(), callback);
}

TEST(SkinBuffers, ShareAllOtherArrays) {
    const auto skin = makeRichSkin();
    test::bend(*skin, 1.0);
    const osg::Geometry& rest = *skin->getRestGeometry();
    const osg::Geometry& posed = *skin->getDeformedGeometry();
    EXPECT_EQ(posed.getTexCoordArray(0), rest.getTexCoordArray(0));
    EXPECT_EQ(posed.getTexCoordArray(2), rest.getTexCoordArray(2));
    EXPECT_EQ(posed.getColorArray(), rest.getColorArray());
    EXPECT_EQ(posed.getVertexAttribArray(7), rest.getVertexAttribArray(7));
    ASSERT_EQ(posed.getNumPrimitiveSets(), 2u);
    for (unsigned int i = 0; i < 2; ++i)
        EXPECT_EQ(posed.getPrimitiveSet(i), rest.getPrimitiveSet(i));
}

/// The model has the vertices, so an application may remove the geometry's.
TEST(SkinBuffers, DoNotNeedTheRestArrays) {
    const auto array = [](const osg::Array* of) {
        return static_cast<const osg::Vec3Array&>(*of).asVector();
    };
    for (const bool cleared : {true, false}) {
        const test::Tube tube;
        const osg::ref_ptr<osg::Geometry> rest = test::makeGeometry(tube);
        const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
        skin->setSkin(rest, tube.model());
        if (cleared) {
            static_cast<osg::Vec3Array&>(*rest->getVertexArray()).clear();
            static_cast<osg::Vec3Array&>(*rest->getNormalArray()).clear();
        } else {
            rest->setVertexArray(nullptr);
            rest->setNormalArray(nullptr);
        }
        const osg::ref_ptr<osgSkin::DeformableSkin> copy =
            osg::clone(skin.get(), osg::CopyOp::SHALLOW_COPY);
        test::bend(*skin, 0.7);
        test::bend(*copy, 0.7);
        const osg::Geometry& a = *skin->getDeformedGeometry();
        const osg::Geometry& b = *copy->getDeformedGeometry();
        EXPECT_EQ(array(a.getVertexArray()), array(b.getVertexArray()));
        EXPECT_EQ(array(a.getNormalArray()), array(b.getNormalArray()));
        EXPECT_EQ(a.getVertexArray()->getNumElements(), tube.positions.size());
    }
}

TEST(SkinBuffers, TangentsFollowTheNormals) {
    const auto skin = makeRichSkin();
    std::vector<const osg::Array*> arrays;
    for (const double angle : {0.0, osg::PI_2}) {
        test::bend(*skin, angle);
        test::cull(*skin, true);
        const osg::Geometry& posed = *skin->getDeformedGeometry();
        const auto& tangents =
            static_cast<const osg::Vec4Array&>(*posed.getVertexAttribArray(kTangents));
        const auto& normals = static_cast<const osg::Vec3Array&>(*posed.getNormalArray());
        for (std::size_t v = 0; v < tangents.size(); ++v) {
            const osg::Vec3 t(tangents[v].x(), tangents[v].y(), tangents[v].z());
            ASSERT_NEAR(t.length(), 1.0f, 1e-5f);
            ASSERT_NEAR(t * normals[v], 0.0f, 1e-5f);
            ASSERT_EQ(tangents[v].w(), v % 2 == 0 ? 1.0f : -1.0f);
        }
        // The tube's top, above the bend about x: a vector along y now points along z.
        const osg::Vec4 top = tangents.back();
        EXPECT_NEAR(top.y(), std::cos(angle), 1e-5);
        EXPECT_NEAR(top.z(), std::sin(angle), 1e-5);
        EXPECT_EQ(static_cast<const osg::Vec4Array&>(
                      *skin->getRestGeometry()->getVertexAttribArray(kTangents))
                      .back()
                      .y(),
                  1.0f);
        arrays.push_back(&tangents);
    }
    EXPECT_NE(arrays[0], arrays[1]); // each buffer has its own
}

TEST(SkinBuffers, AcceptTangentsOfThreeCoordinates) {
    const osg::ref_ptr<osg::Geometry> rest = makeRich();
    const test::Tube tube;
    const osg::ref_ptr<osg::Vec3Array> three = new osg::Vec3Array;
    three->assign(tube.positions.size(), osg::Vec3(0, 1, 0));
    rest->setVertexAttribArray(kTangents, three, osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(rest, tube.model());
    skin->setTangentAttribute(kTangents); // after the skin, too
    test::bend(*skin, osg::PI_2);
    const auto& posed = static_cast<const osg::Vec4Array&>(
        *skin->getDeformedGeometry()->getVertexAttribArray(kTangents));
    EXPECT_NEAR(posed.back().z(), 1.0f, 1e-5f);
    EXPECT_EQ(posed.back().w(), 1.0f);
}

TEST(SkinBuffers, RejectMissingTangents) {
    const auto skin = test::makeSkin();
    EXPECT_THROW(skin->setTangentAttribute(kTangents), osgSkin::Error);
    EXPECT_EQ(skin->getTangentAttribute(), -1);
    const osg::ref_ptr<osgSkin::DeformableSkin> other = new osgSkin::DeformableSkin;
    other->setTangentAttribute(3);
    EXPECT_THROW(other->setSkin(makeRich(), test::Tube().model()), osgSkin::Error);
    const osg::ref_ptr<osg::Geometry> wrong = makeRich();
    wrong->setVertexAttribArray(3, new osg::Vec4Array(5), osg::Array::BIND_PER_VERTEX);
    EXPECT_THROW(other->setSkin(wrong, test::Tube().model()), osgSkin::Error);
}

TEST(DeformableSkin, DeformsOnAPool) {
    const auto skin = test::makeSkin(), alone = test::makeSkin();
    const osg::ref_ptr<osgSkin::DeformPool> pool = new osgSkin::DeformPool(2);
    pool->setMinimumVertices(0);
    skin->setPool(pool);
    test::bend(*skin, 0.7);
    test::bend(*alone, 0.7);
    EXPECT_EQ(verticesOf(*skin), verticesOf(*alone));
}
