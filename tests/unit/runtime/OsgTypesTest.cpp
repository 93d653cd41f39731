// SPDX-License-Identifier: MIT
// Functions with OSG's types equal those with GLM's.
#include "TubeSkin.h"

#include <osgSkin/BendTwist>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/PoseBounds>

#include <gtest/gtest.h>

#include <random>
#include <vector>

using osgSkin::toGlm;
using osgSkin::toOsg;
using test::verticesOf;

namespace {

std::vector<glm::dmat4> somePose(const test::Tube& tube) {
    std::mt19937_64 random(3);
    std::vector<glm::dquat> rotations;
    rotations.reserve(3);
    for (int j = 0; j < 3; ++j) rotations.push_back(test::randomRotation(random));
    return test::skinningFrom(tube.binding.joints, rotations, {0.5, 1.0, -2.0});
}

std::vector<osg::Matrixd> inOsg(const std::vector<glm::dmat4>& matrices) {
    std::vector<osg::Matrixd> result;
    result.reserve(matrices.size());
    for (const glm::dmat4& matrix : matrices) result.push_back(toOsg(matrix));
    return result;
}

} // namespace

TEST(OsgTypes, PoseFromMatrices) {
    const test::Tube tube;
    const std::vector<glm::dmat4> skinning = somePose(tube);
    osgSkin::Pose a(tube.binding.joints), b(tube.binding.joints);
    bool changed = false;
    ASSERT_TRUE(a.set(skinning.data(), 3));
    ASSERT_TRUE(b.set(inOsg(skinning).data(), 3, osgSkin::Pose::Twist::Shortest, &changed));
    EXPECT_TRUE(changed);
    for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_EQ(b.transform(j).rotation, a.transform(j).rotation);
        EXPECT_EQ(b.transform(j).offset, a.transform(j).offset);
    }
    EXPECT_FALSE(b.set(inOsg(skinning).data(), 2));
}

TEST(OsgTypes, SkinPoseFromMatrices) {
    const test::Tube tube;
    const std::vector<glm::dmat4> skinning = somePose(tube);
    const osg::ref_ptr<osgSkin::DeformableSkin> a = test::makeSkin(), b = test::makeSkin();
    ASSERT_TRUE(a->setPose(skinning.data(), 3));
    ASSERT_TRUE(b->setPose(inOsg(skinning)));
    EXPECT_EQ(verticesOf(*b), verticesOf(*a));
    std::vector<osg::Matrixd> tooFew = inOsg(skinning);
    tooFew.pop_back();
    EXPECT_FALSE(b->setPose(tooFew));
}

// A bone's matrix and inverse bind matrix in OSG's multiplication order: a rotation about the
// joint.
TEST(OsgTypes, MatricesMultiplyInOsgsOrder) {
    const osg::ref_ptr<osgSkin::DeformableSkin> a = test::makeSkin(), b = test::makeSkin();
    test::bend(*a, 0.7);
    const osg::Matrixd bend = osg::Matrixd::translate(0, -2, 0) *
                              osg::Matrixd::rotate(0.7, osg::Vec3d(1, 0, 0)) *
                              osg::Matrixd::translate(0, 2, 0);
    ASSERT_TRUE(b->setPose({osg::Matrixd(), bend, bend}));
    const std::vector<osg::Vec3> is = verticesOf(*b), was = verticesOf(*a);
    for (std::size_t v = 0; v < was.size(); ++v) ASSERT_LE((is[v] - was[v]).length(), 1e-6f);
}

TEST(OsgTypes, ModelFromArrays) {
    const test::Tube tube;
    const osg::ref_ptr<osg::Geometry> geometry = test::makeGeometry(tube);
    const auto* vertices = static_cast<const osg::Vec3Array*>(geometry->getVertexArray());
    const auto* normals = static_cast<const osg::Vec3Array*>(geometry->getNormalArray());
    const auto model = osgSkin::SkinModel::create(tube.binding, vertices, normals, tube.source);
    EXPECT_EQ(model->positions(), tube.positions);
    EXPECT_EQ(model->normals(), tube.normals);
    EXPECT_THROW(osgSkin::SkinModel::create(tube.binding, vertices, nullptr, tube.source),
                 osgSkin::Error);
    EXPECT_THROW(osgSkin::SkinModel::create(tube.binding, nullptr, normals, tube.source),
                 osgSkin::Error);
}

TEST(OsgTypes, Bounds) {
    const test::Tube tube;
    const auto model = tube.model();
    const osgSkin::Pose pose(model->joints());
    const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(*model, pose);
    const osg::BoundingBox box = toOsg(bounds);
    EXPECT_EQ(box.yMin(), bounds.low.y);
    EXPECT_EQ(box.zMax(), bounds.high.z);
    EXPECT_TRUE(box.contains(osg::Vec3(0, 3, 0)));
    const osg::ref_ptr<osgSkin::SkinModel> empty = new osgSkin::SkinModel;
    EXPECT_FALSE(toOsg(osgSkin::computePoseBounds(*empty, osgSkin::Pose())).valid());
}

TEST(OsgTypes, BendTwist) {
    const osg::Quat q(0.3, osg::Vec3d(0, 1, 0), 0.5, osg::Vec3d(1, 0, 0), 0.0, osg::Vec3d(0, 0, 1));
    const osg::Vec3d pole(0, 1, 0);
    const osgSkin::BendTwist a = osgSkin::splitBendTwist(toGlm(q), toGlm(pole));
    const osgSkin::BendTwist b = osgSkin::splitBendTwist(q, pole);
    EXPECT_EQ(b.bendAxis, a.bendAxis);
    EXPECT_NEAR(b.bendAngle, 0.5, 1e-12);
    EXPECT_NEAR(b.twistAngle, 0.3, 1e-12);
    const osg::Quat half = osgSkin::partialRotation(b, pole, 0.5, 0.25);
    EXPECT_EQ(toGlm(half), osgSkin::partialRotation(a, toGlm(pole), 0.5, 0.25));

    osgSkin::BendTwist out;
    EXPECT_TRUE(osgSkin::trySplitBendTwist(q, pole, out));
    EXPECT_EQ(out.twistAngle, b.twistAngle);
    EXPECT_FALSE(osgSkin::trySplitBendTwist(q, osg::Vec3d(0, 2, 0), out));
    EXPECT_EQ(out.twistAngle, b.twistAngle);
    EXPECT_THROW(osgSkin::splitBendTwist(osg::Quat(0, 0, 0, 0), pole), osgSkin::Error);
}

TEST(OsgTypes, ClonedModelsAreIndependent) {
    const test::Tube tube;
    const auto model = tube.model();
    const osg::ref_ptr<osgSkin::SkinModel> copy = osg::clone(model.get());
    copy->setName("copy");
    EXPECT_EQ(model->getName(), "");
    EXPECT_EQ(copy->positions(), model->positions());
    const osg::ref_ptr<osgSkin::DeformableSkin> a = test::makeSkin(), b = test::makeSkin();
    b->setSkin(test::makeGeometry(tube), copy);
    const std::vector<glm::dmat4> skinning = somePose(tube);
    ASSERT_TRUE(a->setPose(skinning.data(), 3));
    ASSERT_TRUE(b->setPose(skinning.data(), 3));
    EXPECT_EQ(verticesOf(*b), verticesOf(*a));
}
