// SPDX-License-Identifier: MIT
// What is drawn of a skin: two buffers, filled in turn, with all that the rest geometry has.
#include "TubeSkin.h"

#include <osgSkin/Error>

#include <osg/Point>

#include <gtest/gtest.h>

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

TEST(SkinBuffers, AlternateWhenOneHasBeenHandedOut) {
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

// A pose that is read and replaced within a frame must not reach the buffer that a draw thread is
// still reading.
TEST(SkinBuffers, WhatIsBeingDrawnIsNotWritten) {
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

TEST(SkinBuffers, APausedPoseIsNotDeformedAgain) {
    const auto skin = test::makeSkin();
    for (int frame = 0; frame < 5; ++frame) {
        test::bend(*skin, 0.3);
        test::cull(*skin, true);
    }
    EXPECT_EQ(skin->getDeformCount(), 1u);
    EXPECT_DOUBLE_EQ(skin->getPose().transform(1).split.bendAngle, 0.3);
}

TEST(SkinBuffers, DoNotHoldUpTheNextUpdate) {
    const auto skin = test::makeSkin();
    EXPECT_NE(skin->getDeformedGeometry()->getDataVariance(), osg::Object::DYNAMIC);
    EXPECT_FALSE(skin->getDeformedGeometry()->getUseDisplayList());
}

TEST(SkinBuffers, FollowTheVertexBufferSetting) {
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

/// What one skin lets go, others may be drawing with, in this very moment.
TEST(SkinBuffers, LeaveAloneWhatOthersDrawWith) {
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
    skin->releaseGLObjects(nullptr); // by order
    EXPECT_GT(releases, 0);
}

TEST(SkinBuffers, FollowTheDrawCallback) {
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
    skin->setDrawCallback(callback); // and where no pose follows
    EXPECT_EQ(skin->getDeformedGeometry()->getDrawCallback(), callback);
}

TEST(SkinBuffers, KeepEverythingElse) {
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

/// The model has the vertices, so an application may drop the geometry's.
TEST(SkinBuffers, NeedNoArraysOfTheRestGeometry) {
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

TEST(SkinBuffers, TangentsTurnWithTheNormals) {
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
        // The tube's top, beyond the bend about x: what pointed up points along z.
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

TEST(SkinBuffers, TangentsMayHaveThreeCoordinates) {
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

TEST(SkinBuffers, TangentsThatAreNotThereAreRefused) {
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
