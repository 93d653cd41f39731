// SPDX-License-Identifier: MIT
#include "SlopedTube.h"
#include "SomeMorphs.h"
#include "Turns.h"

#include <osgSkin/Deform>
#include <osgSkin/Error>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

const std::vector<glm::dquat> kTurns = {glm::angleAxis(0.4, glm::dvec3(0, 0, 1)),
                                        glm::angleAxis(0.9, glm::dvec3(1, 0, 0)),
                                        glm::angleAxis(-0.7, glm::normalize(glm::dvec3(1, 2, 3)))};

} // namespace

TEST(Deform, RunsTheCodeOfTheReadme) {
#include "vertex.inc"
    // Half of a bend of 1.2 about z, at the elbow.
    EXPECT_NEAR(posed.x, 0.3 * std::cos(0.6), 1e-6);
    EXPECT_NEAR(posed.y, 2.0 + 0.3 * std::sin(0.6), 1e-6);
    EXPECT_NEAR(posed.z, 0.0, 1e-6);
}

TEST(Deform, WritesWhatAJobWrites) {
    const test::SlopedTube tube;
    const auto model = tube.model();
    const auto tangents = osgSkin::SkinTangents::create(
        model, std::vector<glm::vec4>(model->vertexCount(), glm::vec4(0, 1, 0, -1)));
    osgSkin::MorphedRest morphed(
        model, osgSkin::MorphTargets::create(test::someMorphs(model->vertexCount(), 0.1),
                                             model->vertexCount()));
    morphed.set({0.5f, 0.25f, -0.5f});
    const auto skinning = test::skinningFrom(model->joints(), kTurns);
    osgSkin::Pose pose(model->joints());
    ASSERT_TRUE(pose.set(skinning.data(), skinning.size()));
    osgSkin::DeformedVertices expected;
    expected.positions.resize(model->vertexCount());
    expected.normals.resize(model->vertexCount());
    expected.tangents.resize(model->vertexCount());
    osgSkin::DeformJob job;
    job.model = model.get();
    job.pose = &pose;
    job.morphed = &morphed;
    job.restTangents = tangents.get();
    job.positions = expected.positions.data();
    job.normals = expected.normals.data();
    job.tangents = expected.tangents.data();
    job.positionCount = job.normalCount = job.tangentCount = model->vertexCount();
    osgSkin::DeformOptions options;
    options.normals = true;
    options.restTangents = tangents.get();
    options.morphed = &morphed;
    for (const bool reference : {false, true}) {
        options.reference = reference;
        ASSERT_TRUE(reference ? job.runReference() : job.run());
        const osgSkin::DeformedVertices is = osgSkin::deform(*model, pose, options);
        EXPECT_EQ(is.positions, expected.positions);
        EXPECT_EQ(is.normals, expected.normals);
        EXPECT_EQ(is.tangents, expected.tangents);
    }
}

TEST(Deform, ComputesPositionsAloneByDefault) {
    const test::Tube tube;
    const auto skinning = test::skinningFrom(tube.binding.joints, kTurns);
    const osgSkin::DeformedVertices posed = osgSkin::deform(*tube.model(), skinning);
    EXPECT_EQ(posed.positions.size(), tube.positions.size());
    EXPECT_TRUE(posed.normals.empty());
    EXPECT_TRUE(posed.tangents.empty());
    const std::vector<glm::dvec3> rest(tube.positions.begin(), tube.positions.end());
    const std::vector<glm::dvec3> bound = osgSkin::deform(tube.binding, rest, skinning);
    EXPECT_EQ(bound, std::vector<glm::dvec3>(posed.positions.begin(), posed.positions.end()));
}

TEST(Deform, GivesNothingForAModelWithoutVertices) {
    const osg::ref_ptr<const osgSkin::SkinModel> model = new osgSkin::SkinModel;
    EXPECT_TRUE(osgSkin::deform(*model, osgSkin::Pose()).positions.empty());
}

TEST(Deform, RejectsInvalidArguments) {
    const test::Tube tube;
    const auto model = tube.model(), other = tube.model();
    const osgSkin::Pose pose(model->joints());
    osgSkin::DeformOptions options;
    EXPECT_THROW(osgSkin::deform(*model, osgSkin::Pose()), osgSkin::Error);
    EXPECT_THROW(osgSkin::deform(*model, std::vector<glm::dmat4>(2, glm::dmat4(1.0))),
                 osgSkin::Error);
    EXPECT_THROW(osgSkin::deform(*model, std::vector<glm::dmat4>(3, glm::dmat4(0.0))),
                 osgSkin::Error);
    EXPECT_THROW(osgSkin::deform(tube.binding, {}, {}), osgSkin::Error);
    const auto tangents = osgSkin::SkinTangents::create(
        other, std::vector<glm::vec4>(other->vertexCount(), glm::vec4(0, 1, 0, 1)));
    options.restTangents = tangents.get();
    EXPECT_THROW(osgSkin::deform(*other, pose, options), osgSkin::Error) << "without normals";
    options.normals = true;
    EXPECT_NO_THROW(osgSkin::deform(*other, pose, options));
    EXPECT_THROW(osgSkin::deform(*model, pose, options), osgSkin::Error) << "of another model";
}
