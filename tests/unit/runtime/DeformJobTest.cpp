// SPDX-License-Identifier: MIT
#include "Tube.h"
#include "Turns.h"

#include <osgSkin/DeformJob>
#include <osgSkin/Error>

#include <gtest/gtest.h>
#include <osg/ref_ptr>

#include <cfenv>
#include <functional>
#include <string>
#include <vector>

using osgSkin::DeformJob;
using osgSkin::Pose;

namespace {

/// The deformation in double precision, vertex by vertex and joint by joint, by DESIGN's formula:
/// no groups, no folding.
glm::dvec3 reference(const osgSkin::Binding& binding, std::uint32_t vertex, glm::dvec3 x,
                     const std::vector<glm::dmat4>& skinning) {
    for (std::uint32_t i = binding.firstInfluence[vertex + 1];
         i-- > binding.firstInfluence[vertex];) {
        const osgSkin::Influence& influence = binding.influences[i];
        const osgSkin::BoundJoint& joint = binding.joints[influence.joint];
        if (joint.parent < 0) return glm::dvec3(skinning[0] * glm::dvec4(x, 1.0));
        const glm::dmat4 local = glm::inverse(skinning[static_cast<std::size_t>(joint.parent)]) *
                                 skinning[influence.joint];
        const osgSkin::BendTwist split =
            osgSkin::splitBendTwist(glm::quat_cast(glm::dmat3(local)), joint.twistAxis);
        x = joint.centre + osgSkin::partialRotation(split, joint.twistAxis, double(influence.bend),
                                                    double(influence.twist)) *
                               (x - joint.centre);
    }
    return x;
}

struct Deformed {
    explicit Deformed(const test::Tube& tube)
        : model(tube.model()), pose(model->joints()), positions(tube.positions.size()),
          normals(tube.positions.size()) {
        job.model = model.get();
        job.pose = &pose;
        job.positions = positions.data();
        job.positionCount = positions.size();
        job.normals = normals.data();
        job.normalCount = normals.size();
    }
    Deformed(const Deformed&) = delete;

    osg::ref_ptr<const osgSkin::SkinModel> model;
    Pose pose;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
    osg::ref_ptr<const osgSkin::SkinTangents> restTangents;
    DeformJob job;

    /// Adds tangents along the tube, of both handednesses.
    void addTangents() {
        for (std::size_t v = 0; v < positions.size(); ++v)
            tangents.emplace_back(0, 1, 0, v % 2 == 0 ? 1 : -1);
        restTangents = osgSkin::SkinTangents::create(model, tangents);
        job.restTangents = restTangents.get();
        job.tangents = tangents.data();
        job.tangentCount = tangents.size();
    }
};

/// The message of the error that validate() throws; empty if none.
std::string reasonAgainst(const DeformJob& job) {
    try {
        job.validate();
        return "";
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
}

} // namespace

TEST(DeformJob, DefaultIsInvalid) {
    const DeformJob job;
    EXPECT_EQ(reasonAgainst(job), "deform job: no model");
    EXPECT_FALSE(job.isValid());
    EXPECT_FALSE(job.run());
    EXPECT_FALSE(job.runPart(0));
}

TEST(DeformJob, AcceptsAModelWithoutVertices) {
    const osg::ref_ptr<const osgSkin::SkinModel> model = new osgSkin::SkinModel;
    const Pose pose(model->joints());
    glm::vec3 nothing(7.0f);
    DeformJob job;
    job.model = model;
    job.pose = &pose;
    job.positions = &nothing;
    EXPECT_TRUE(job.isValid());
    EXPECT_TRUE(job.run());
    EXPECT_EQ(job.partCount(), 0u);
    EXPECT_EQ(nothing, glm::vec3(7.0f));
}

TEST(DeformJob, RejectsMissingOrMismatchedFields) {
    const test::Tube tube;
    Deformed good(tube);
    good.addTangents();
    Deformed other(tube);
    other.addTangents();
    ASSERT_EQ(reasonAgainst(good.job), "");
    ASSERT_TRUE(good.job.isValid());
    const Pose foreign;
    struct Case {
        const char* name;
        std::function<void(DeformJob&)> spoil;
    };
    const Case cases[] = {
        {"no pose", [](DeformJob& job) { job.pose = nullptr; }},
        {"foreign pose", [&](DeformJob& job) { job.pose = &foreign; }},
        {"no positions", [](DeformJob& job) { job.positions = nullptr; }},
        {"too few positions", [](DeformJob& job) { --job.positionCount; }},
        {"too few normals", [](DeformJob& job) { --job.normalCount; }},
        {"tangents alone", [](DeformJob& job) { job.normals = nullptr; }},
        {"no rest tangents", [](DeformJob& job) { job.restTangents = nullptr; }},
        {"rest tangents of another model",
         [&](DeformJob& job) { job.restTangents = other.restTangents.get(); }},
        {"too few tangents", [](DeformJob& job) { --job.tangentCount; }},
    };
    for (const Case& c : cases) {
        DeformJob job = good.job;
        c.spoil(job);
        EXPECT_NE(reasonAgainst(job), "") << c.name;
        EXPECT_FALSE(job.isValid()) << c.name;
        EXPECT_FALSE(job.run()) << c.name;
        EXPECT_FALSE(job.runReference()) << c.name;
    }
}

TEST(DeformJob, RotatesTangentsAndKeepsHandedness) {
    const test::Tube tube;
    Deformed deformed(tube);
    deformed.addTangents();
    const auto turn = glm::angleAxis(1.0, glm::dvec3(0, 0, 1));
    const auto skinning = test::skinningFrom(
        tube.binding.joints, {turn, glm::dquat(1, 0, 0, 0), glm::dquat(1, 0, 0, 0)});
    ASSERT_TRUE(deformed.pose.set(skinning.data(), skinning.size()));
    ASSERT_TRUE(deformed.job.run());
    const glm::dvec3 expected = turn * glm::dvec3(0, 1, 0);
    for (std::size_t v = 0; v < deformed.tangents.size(); ++v) {
        EXPECT_LE(glm::distance(glm::dvec3(deformed.tangents[v]), expected), 1e-6);
        EXPECT_EQ(deformed.tangents[v].w, v % 2 == 0 ? 1.0f : -1.0f);
    }
}

TEST(DeformJob, RestPoseGivesExactRestVertices) {
    const test::Tube tube;
    Deformed deformed(tube);
    ASSERT_TRUE(deformed.job.run());
    EXPECT_EQ(deformed.positions, tube.positions);
    EXPECT_EQ(deformed.normals, tube.normals);
}

TEST(DeformJob, MatchesDoublePrecision) {
    const test::Tube tube;
    Deformed deformed(tube);
    std::mt19937_64 random(5);
    for (int i = 0; i < 200; ++i) {
        const std::vector<glm::dquat> turns = {test::randomRotation(random),
                                               test::randomRotation(random),
                                               test::randomRotation(random)};
        const auto skinning =
            test::skinningFrom(deformed.model->joints(), turns, test::randomUnit(random));
        ASSERT_TRUE(deformed.pose.set(skinning.data(), skinning.size()));
        ASSERT_TRUE(deformed.job.run());
        for (std::uint32_t v = 0; v < tube.positions.size(); ++v) {
            const glm::dvec3 at = glm::dvec3(tube.positions[v]);
            const glm::dvec3 expected = reference(tube.binding, v, at, skinning);
            ASSERT_LE(glm::distance(glm::dvec3(deformed.positions[v]), expected), 6.0 * 1e-6);
            const glm::dvec3 tip =
                reference(tube.binding, v, at + glm::dvec3(tube.normals[v]), skinning);
            ASSERT_LE(glm::distance(glm::dvec3(deformed.normals[v]), tip - expected), 1e-5);
        }
    }
}

// Motions are full of joints that move only by rounding errors: the powers of such angles are
// denormal numbers, which are many times slower on CPUs.
TEST(DeformJob, AvoidsDenormalsForTinyAngles) {
    const test::Tube tube;
    Deformed f(tube);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));
    for (const double angle : {1e-10, 1e-13, 1e-16, 1e-17, 1e-19}) {
        const auto skinning = test::skinningFrom(
            f.model->joints(), {glm::angleAxis(angle, axis), glm::angleAxis(2.0 * angle, axis),
                                glm::angleAxis(-angle, axis)});
        ASSERT_TRUE(f.pose.set(skinning.data(), skinning.size()));
        std::feclearexcept(FE_UNDERFLOW);
        ASSERT_TRUE(f.job.run());
        EXPECT_FALSE(std::fetestexcept(FE_UNDERFLOW)) << angle;
    }
}

TEST(DeformJob, NormalsAreOptional) {
    const test::Tube tube;
    Deformed deformed(tube);
    deformed.job.normals = nullptr;
    deformed.job.normalCount = 0;
    EXPECT_TRUE(deformed.job.run());
    EXPECT_EQ(deformed.positions, tube.positions);
}

/// Skin that follows the joints fully is transformed by their matrices, as in linear blending.
TEST(DeformJob, ScaledJointsMoveFullyWeightedVertices) {
    const test::Tube tube;
    Deformed deformed(tube);
    std::mt19937_64 random(16);
    std::uniform_real_distribution<double> growth(0.25, 4.0);
    for (int i = 0; i < 50; ++i) {
        std::vector<glm::dmat4> skinning;
        double size = 1.0;
        for (std::size_t j = 0; j < 3; ++j) {
            const glm::dvec3 c = deformed.model->joints()[j].centre;
            const double s = growth(random);
            size = std::max(size, s * size);
            const glm::dmat4 own = glm::translate(glm::dmat4(1.0), c + test::randomUnit(random)) *
                                   glm::mat4_cast(test::randomRotation(random)) *
                                   glm::scale(glm::dmat4(1.0), glm::dvec3(s)) *
                                   glm::translate(glm::dmat4(1.0), -c);
            skinning.push_back(j == 0 ? own : skinning.back() * own);
        }
        ASSERT_TRUE(deformed.pose.set(skinning.data(), skinning.size()));
        ASSERT_TRUE(deformed.job.run());
        std::size_t full = 0;
        for (std::uint32_t v = 0; v < tube.positions.size(); ++v) {
            const std::uint32_t first = tube.binding.firstInfluence[v];
            const std::uint32_t end = tube.binding.firstInfluence[v + 1];
            bool fully = true;
            for (std::uint32_t k = first; k < end; ++k)
                fully = fully && tube.binding.influences[k].bend == 1.0f &&
                        tube.binding.influences[k].twist == 1.0f;
            EXPECT_NEAR(double(glm::length(deformed.normals[v])), 1.0, 1e-5);
            if (!fully) continue;
            ++full;
            const glm::dmat4& g = skinning[tube.binding.influences[end - 1].joint];
            ASSERT_LE(glm::distance(glm::dvec3(deformed.positions[v]),
                                    glm::dvec3(g * glm::dvec4(glm::dvec3(tube.positions[v]), 1.0))),
                      6.0 * 2e-6 * size);
        }
        EXPECT_GT(full, 0u);
    }
}
