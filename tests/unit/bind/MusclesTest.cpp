// SPDX-License-Identifier: GPL-3.0-or-later
// Muscles that swell with their joints' bends and with the application's activations.
#include "KnownBody.h"

#include <osgSkin/DeformJob>
#include <osgSkin/Error>
#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

using namespace osgSkin;

namespace {

const CorrectiveJoint* driverOf(const Binding& binding, const std::string& joint,
                                CorrectiveJoint::Basis basis) {
    for (const CorrectiveJoint& driver : binding.correctives.joints)
        if (driver.basis == basis && binding.joints[driver.joint].name == joint) return &driver;
    return nullptr;
}

/// A bound body that is posed by one joint and its inputs.
class MuscleBody {
public:
    explicit MuscleBody(const BindOptions& options)
        : binding(bind(body.mesh, body.truth, options)) {
        std::vector<std::uint32_t> source(body.mesh.positions.size());
        std::iota(source.begin(), source.end(), 0u);
        _model =
            SkinModel::create(binding, {body.mesh.positions.begin(), body.mesh.positions.end()},
                              std::vector<glm::vec3>(source.size(), {0, 1, 0}), source);
    }

    std::size_t joint(const std::string& name) const {
        return static_cast<std::size_t>(body.truth.find(name));
    }

    /// Bends the joint to `degrees` from straight.
    std::vector<glm::vec3> posed(const std::string& name, const glm::dvec3& axis, double degrees,
                                 const std::map<std::string, float>& tensed = {}) const {
        const std::size_t j = joint(name);
        const BoundJoint& hinge = binding.joints[j];
        const BoundJoint& above = binding.joints[std::size_t(hinge.parent)];
        const glm::dvec3 a = glm::normalize(hinge.centre - above.centre);
        const double atRest =
            std::atan2(glm::dot(glm::cross(a, hinge.boneAxis), axis), glm::dot(a, hinge.boneAxis));
        const glm::dmat4 unit(1.0);
        const glm::dmat4 turn = glm::translate(unit, hinge.centre) *
                                glm::rotate(unit, glm::radians(degrees) - atRest, axis) *
                                glm::translate(unit, -hinge.centre);
        std::vector<glm::dmat4> skinning(binding.joints.size(), unit);
        for (std::size_t i = 0; i < skinning.size(); ++i)
            if (body.truth.isInSubtree(static_cast<int>(i), static_cast<int>(j)))
                skinning[i] = turn;
        Pose pose(binding.joints, _model->inputs().size());
        EXPECT_TRUE(pose.set(skinning.data(), skinning.size()));
        for (std::size_t i = 0; i < _model->inputs().size(); ++i) {
            const auto found = tensed.find(_model->inputs()[i]);
            EXPECT_TRUE(pose.setInput(i, found == tensed.end() ? 0.0f : found->second));
        }
        std::vector<glm::vec3> result(body.mesh.positions.size());
        DeformJob job;
        job.model = _model.get();
        job.pose = &pose;
        job.positions = result.data();
        job.positionCount = result.size();
        EXPECT_TRUE(job.run());
        return result;
    }

    /// The girth of the limb above a joint, halfway along its bone.
    double girth(const std::string& name, const std::vector<glm::vec3>& skin) const {
        const BoundJoint& hinge = binding.joints[joint(name)];
        const glm::dvec3 begin = binding.joints[std::size_t(hinge.parent)].centre;
        const glm::dvec3 middle = 0.5 * (begin + hinge.centre);
        const glm::dvec3 along = glm::normalize(hinge.centre - begin);
        const double near = 0.45 * glm::length(hinge.centre - begin);
        double girth = 0.0;
        const std::vector<std::uint32_t> corners = body.mesh.triangles();
        for (std::size_t t = 0; t < corners.size(); t += 3) {
            glm::dvec3 cut[2];
            int found = 0;
            for (std::size_t c = 0; c < 3 && found < 2; ++c) {
                const glm::dvec3 p(skin[corners[t + c]]), q(skin[corners[t + (c + 1) % 3]]);
                const double h = glm::dot(p - middle, along), k = glm::dot(q - middle, along);
                if ((h < 0.0) != (k < 0.0)) cut[found++] = p + (q - p) * (h / (h - k));
            }
            if (found == 2 && glm::length(cut[0] - middle) < near)
                girth += glm::length(cut[1] - cut[0]);
        }
        return girth;
    }

    double volume(const std::vector<glm::vec3>& skin) const {
        double volume = 0.0;
        const std::vector<std::uint32_t> corners = body.mesh.triangles();
        for (std::size_t t = 0; t < corners.size(); t += 3)
            volume += glm::dot(glm::dvec3(skin[corners[t]]),
                               glm::cross(glm::dvec3(skin[corners[t + 1]]),
                                          glm::dvec3(skin[corners[t + 2]]))) /
                      6.0;
        return volume;
    }

    /// Volume of the limb above a joint, as a cylinder.
    double limbVolume(const std::string& name, double girth) const {
        const BoundJoint& hinge = binding.joints[joint(name)];
        return girth * girth / (4.0 * glm::pi<double>()) *
               glm::length(hinge.centre - binding.joints[std::size_t(hinge.parent)].centre);
    }

    KnownBody body = KnownBody::thrower();
    Binding binding;

private:
    osg::ref_ptr<const SkinModel> _model;
};

BindOptions withMuscles() {
    BindOptions options;
    options.shapes = BindOptions::Shapes::None;
    options.muscles = true;
    return options;
}

BindOptions without() {
    BindOptions options;
    options.shapes = BindOptions::Shapes::None;
    return options;
}

/// Measures of one arm's biceps.
class Biceps : public testing::TestWithParam<const char*> {
protected:
    const MuscleBody muscles{withMuscles()}, plain{without()};
    const std::string elbow = std::string(GetParam()) + "ForeArm";
    const std::string name = std::string(GetParam()) + "Biceps";
    glm::dvec3 axis{0.0};

    void SetUp() override {
        const CorrectiveJoint* driver =
            driverOf(muscles.binding, elbow, CorrectiveJoint::Basis::Hinge);
        ASSERT_TRUE(driver);
        axis = driver->axis;
    }
};

} // namespace

TEST_P(Biceps, GrowsAsArmsDo) {
    const auto flexed = muscles.posed(elbow, axis, 120.0), still = plain.posed(elbow, axis, 120.0);
    const double growth = muscles.girth(elbow, flexed) / plain.girth(elbow, still) - 1.0;
    RecordProperty("percent", std::to_string(100.0 * growth));
    EXPECT_GT(growth, 0.08);
    EXPECT_LT(growth, 0.15);
    // Gradual, and nothing at rest.
    double before = -1.0;
    for (const double degrees : {10.0, 40.0, 60.0, 80.0, 100.0, 120.0, 140.0}) {
        const double now = muscles.girth(elbow, muscles.posed(elbow, axis, degrees));
        EXPECT_GT(now, before) << degrees;
        before = now;
    }
}

TEST_P(Biceps, KeepsItsVolume) {
    for (const double degrees : {20.0, 60.0, 90.0, 120.0, 140.0})
        for (const float tensed : {0.0f, 1.0f}) {
            const auto with = muscles.posed(elbow, axis, degrees, {{name, tensed}});
            const auto still = plain.posed(elbow, axis, degrees);
            EXPECT_NEAR(muscles.volume(with), plain.volume(still),
                        0.01 * plain.limbVolume(elbow, plain.girth(elbow, still)))
                << degrees << ", " << tensed;
        }
}

TEST_P(Biceps, SwellsWhereItIsTensed) {
    for (const double degrees : {60.0, 75.0, 90.0}) {
        const double loose = muscles.girth(elbow, muscles.posed(elbow, axis, degrees));
        const double half =
            muscles.girth(elbow, muscles.posed(elbow, axis, degrees, {{name, 0.5f}}));
        const double tense =
            muscles.girth(elbow, muscles.posed(elbow, axis, degrees, {{name, 1.0f}}));
        EXPECT_GT(tense / loose - 1.0, 0.05) << degrees;
        EXPECT_GT(half, loose);
        EXPECT_LT(half, tense);
        // Activations above the maximum have no further effect.
        EXPECT_EQ(muscles.posed(elbow, axis, degrees, {{name, 1.0f}}),
                  muscles.posed(elbow, axis, degrees, {{name, 7.0f}}));
    }
}

INSTANTIATE_TEST_SUITE_P(Arms, Biceps, testing::Values("Left", "Right"),
                         [](const auto& arm) { return std::string(arm.param); });

TEST(Muscles, AreMadeForArmsAndLegs) {
    const Correctives correctives = MuscleBody(withMuscles()).binding.correctives;
    for (const char* side : {"Left", "Right"})
        for (const char* name : {"Biceps", "Triceps", "Quadriceps", "Hamstrings", "Calf"})
            EXPECT_EQ(std::count(correctives.inputs.begin(), correctives.inputs.end(),
                                 std::string(side) + name),
                      1)
                << side << name;
    EXPECT_EQ(correctives.inputs.size(), 10u);
}

TEST(Muscles, AreOffByDefault) {
    EXPECT_TRUE(MuscleBody(without()).binding.correctives.empty());
}

TEST(Muscles, AddToShapes) {
    BindOptions both = withMuscles(), fast = without();
    both.shapes = fast.shapes = BindOptions::Shapes::Fast;
    const Correctives with = MuscleBody(both).binding.correctives;
    const Correctives shapes = MuscleBody(fast).binding.correctives;
    const Correctives muscles = MuscleBody(withMuscles()).binding.correctives;
    EXPECT_EQ(with.joints.size(), shapes.joints.size() + muscles.joints.size());
    EXPECT_EQ(with.shares.size(), shapes.shares.size() + muscles.shares.size());
}

TEST(Muscles, MayBeTheAuthorsOwn) {
    BindOptions options = without();
    options.ownMuscles.push_back(
        {"Brachioradialis", "RightHand", {}, glm::dvec3(0, 0, 1), 0.0, 0.7, 0.1, 0.1});
    const MuscleBody body(options);
    EXPECT_EQ(body.binding.correctives.inputs, std::vector<std::string>{"Brachioradialis"});
    // A muscle with an automatic one's name replaces it.
    options = withMuscles();
    options.ownMuscles.push_back(
        {"LeftBiceps", "LeftForeArm", BindOptions::Muscle::Side::Flexor, {}, 0.1, 0.95, 0.3, 0.0});
    const MuscleBody strong(options);
    const glm::dvec3 axis =
        driverOf(strong.binding, "LeftForeArm", CorrectiveJoint::Basis::Hinge)->axis;
    const MuscleBody plain(without());
    EXPECT_GT(strong.girth("LeftForeArm", strong.posed("LeftForeArm", axis, 120.0)),
              1.2 * plain.girth("LeftForeArm", plain.posed("LeftForeArm", axis, 120.0)));
}

TEST(Muscles, BadOnesAreRefused) {
    using Muscle = BindOptions::Muscle;
    const KnownBody body = KnownBody::thrower();
    const Muscle good{"A", "LeftForeArm", Muscle::Side::Flexor, {}, 0.1, 0.9, 0.1, 0.1};
    const auto refused = [&](const Muscle& muscle, const std::string& reason, bool twice = false) {
        BindOptions options;
        options.ownMuscles.push_back(muscle);
        if (twice) options.ownMuscles.push_back(muscle);
        try {
            bind(body.mesh, body.truth, options);
            ADD_FAILURE() << "taken: " << reason;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
        }
    };
    Muscle bad = good;
    bad.name = "";
    refused(bad, "no name");
    bad = good;
    bad.joint = "Tail";
    refused(bad, "\"Tail\"");
    bad = good;
    bad.joint = "Hips";
    refused(bad, "no bone above");
    bad = good;
    bad.to = 0.1;
    refused(bad, "fractions of the bone");
    bad = good;
    bad.towards = glm::dvec3(0.0);
    refused(bad, "direction");
    bad = good;
    bad.joint = "LeftHand";
    refused(bad, "bends in no direction");
    bad = good;
    bad.growth = std::nan("");
    refused(bad, "grows by");
    refused(good, "two muscles", true);
}
