// SPDX-License-Identifier: GPL-3.0-or-later
// Muscles that swell with their joints' bends and with the application's activations.
#include "KnownBody.h"

#include <osgSkin/Deform>
#include <osgSkin/Error>
#include <osgSkinBind/Bind>
#include <osgSkinRig/JointRoles>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

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
    explicit MuscleBody(const BindOptions& options, KnownBody of = KnownBody::thrower())
        : body(std::move(of)), binding(bind(body.mesh, body.truth, options, &report)) {
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
        return deform(*_model, pose).positions;
    }

    /// The length of the loop of skin that is around the limb above a joint at rest, at this
    /// fraction of the bone.
    double girth(const std::string& name, const std::vector<glm::vec3>& skin,
                 double fraction = 0.55) const {
        const BoundJoint& hinge = binding.joints[joint(name)];
        const glm::dvec3 begin = binding.joints[std::size_t(hinge.parent)].centre;
        const glm::dvec3 middle = glm::mix(begin, hinge.centre, fraction);
        const glm::dvec3 along = glm::normalize(hinge.centre - begin);
        const double near = 0.45 * glm::length(hinge.centre - begin);
        double girth = 0.0;
        const std::vector<std::uint32_t> corners = body.mesh.triangles();
        for (std::size_t t = 0; t < corners.size(); t += 3) {
            glm::dvec3 cut[2], atRest[2];
            int found = 0;
            for (std::size_t c = 0; c < 3 && found < 2; ++c) {
                const std::uint32_t a = corners[t + c], b = corners[t + (c + 1) % 3];
                const glm::dvec3 p = body.mesh.positions[a], q = body.mesh.positions[b];
                const double h = glm::dot(p - middle, along), k = glm::dot(q - middle, along);
                if ((h < 0.0) == (k < 0.0)) continue;
                atRest[found] = glm::mix(p, q, h / (h - k));
                cut[found++] = glm::mix(glm::dvec3(skin[a]), glm::dvec3(skin[b]), h / (h - k));
            }
            if (found == 2 && glm::length(atRest[0] - middle) < near)
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

    KnownBody body;
    BindReport report;
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

/// MakeHuman's bodies, each with one of its rigs.
class MusclesOfBodies : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

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

TEST_P(Biceps, TapersIntoTendonsThatDoNotShrinkTheArm) {
    const auto flexed = muscles.posed(elbow, axis, 120.0), still = plain.posed(elbow, axis, 120.0);
    double most = 0.0;
    int thick = 0;
    for (int percent = 20; percent <= 85; percent += 5) {
        const double at = 0.01 * percent;
        const double growth =
            muscles.girth(elbow, flexed, at) / plain.girth(elbow, still, at) - 1.0;
        EXPECT_GE(growth, -1e-6) << percent;
        most = std::max(most, growth);
        if (growth > 0.05) ++thick;
    }
    // The belly is over most of the bone, not a ball on it.
    EXPECT_GE(thick, 8);
    for (const double end : {0.1, 0.97})
        EXPECT_NEAR(muscles.girth(elbow, flexed, end) / plain.girth(elbow, still, end), 1.0,
                    0.25 * most)
            << end;
}

TEST_P(Biceps, KeepsTheBodysVolume) {
    for (const double degrees : {20.0, 60.0, 90.0, 120.0, 140.0})
        for (const float tensed : {0.0f, 1.0f}) {
            const double with =
                muscles.volume(muscles.posed(elbow, axis, degrees, {{name, tensed}}));
            EXPECT_NEAR(with / plain.volume(plain.posed(elbow, axis, degrees)), 1.0, 0.01)
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

TEST_P(MusclesOfBodies, GrowAsArmsDo) {
    const std::string shape = std::get<0>(GetParam()), rig = std::get<1>(GetParam());
    const KnownBody body = KnownBody::shared("body4k_" + shape, rig + "_" + shape);
    if (body.mesh.positions.empty())
        GTEST_SKIP() << "needs MakeHuman's bodies in " << OSGSKIN_SHARED_DATA;
    const MuscleBody muscles(withMuscles(), body), plain(without(), body);
    const JointRoles roles = recogniseJoints(body.truth);
    EXPECT_EQ(muscles.binding.correctives.inputs.size(), 22u);
    for (const std::string side : {"Left", "Right"}) {
        const std::string elbow =
            body.truth.joints[std::size_t(roles.joints.at(side + "LowerArm").front())].name;
        const CorrectiveJoint* driver =
            driverOf(muscles.binding, elbow, CorrectiveJoint::Basis::Hinge);
        ASSERT_TRUE(driver);
        const auto flexed = muscles.posed(elbow, driver->axis, 120.0);
        const auto still = plain.posed(elbow, driver->axis, 120.0);
        double most = 0.0;
        for (int percent = 20; percent <= 85; percent += 5) {
            const double at = 0.01 * percent;
            const double growth =
                muscles.girth(elbow, flexed, at) / plain.girth(elbow, still, at) - 1.0;
            EXPECT_GE(growth, -1e-6) << side << percent;
            most = std::max(most, growth);
        }
        EXPECT_GT(most, 0.08) << side;
        EXPECT_LT(most, 0.15) << side;
        const auto tensed = muscles.posed(elbow, driver->axis, 75.0, {{side + "Biceps", 1.0f}});
        const auto loose = muscles.posed(elbow, driver->axis, 75.0);
        EXPECT_GT(muscles.girth(elbow, tensed) / muscles.girth(elbow, loose), 1.05) << side;
        EXPECT_NEAR(muscles.volume(flexed) / plain.volume(still), 1.0, 0.01) << side;
    }
}

INSTANTIATE_TEST_SUITE_P(Shared, MusclesOfBodies,
                         testing::Combine(testing::Values("neutral", "male", "female", "child",
                                                          "female_old", "male_heavy"),
                                          testing::Values("cmu_mb", "game_engine")),
                         [](const auto& body) {
                             return std::string(std::get<0>(body.param)) + "_" +
                                    std::get<1>(body.param);
                         });

TEST(Muscles, AreMadeForArmsLegsAndTrunk) {
    const MuscleBody body(withMuscles());
    const Correctives& correctives = body.binding.correctives;
    for (const char* side : {"Left", "Right"})
        for (const char* name :
             {"Biceps", "Triceps", "ForearmFlexors", "ForearmExtensors", "Quadriceps", "Hamstrings",
              "Calf", "Deltoid", "Pectoral", "Trapezius", "Gluteus"})
            EXPECT_EQ(std::count(correctives.inputs.begin(), correctives.inputs.end(),
                                 std::string(side) + name),
                      1)
                << side << name;
    EXPECT_EQ(correctives.inputs.size(), 22u);
    for (const char* joint :
         {"LeftShoulder", "RightShoulder", "LeftArm", "RightArm", "LeftUpLeg", "RightUpLeg"})
        EXPECT_TRUE(driverOf(body.binding, joint, CorrectiveJoint::Basis::Round)) << joint;
    for (const char* joint : {"LeftHand", "RightHand", "LeftFoot", "RightFoot"})
        EXPECT_TRUE(driverOf(body.binding, joint, CorrectiveJoint::Basis::Hinge)) << joint;
}

TEST(Muscles, LiftTheSkinOverThemOnTheirOwnSide) {
    const MuscleBody body(withMuscles());
    const glm::dvec3 any(1.0, 0.0, 0.0);
    const double elbow = 0.0; // its bend does not matter
    const auto relaxed = body.posed("LeftForeArm", any, elbow);
    const struct {
        const char* name;
        glm::dvec3 way; ///< of a body that faces +z
    } kTrunk[] = {{"Deltoid", {0, 1, 0}},
                  {"Pectoral", {0, 0, 1}},
                  {"Trapezius", {0, 1, 0}},
                  {"Gluteus", {0, 0, -1}}};
    for (const auto& muscle : kTrunk) {
        double sizes[2];
        for (const int side : {0, 1}) {
            const std::string name = (side ? "Right" : "Left") + std::string(muscle.name);
            const auto tensed = body.posed("LeftForeArm", any, elbow, {{name, 1.0f}});
            glm::dvec3 moved(0.0);
            sizes[side] = 0.0;
            for (std::size_t v = 0; v < tensed.size(); ++v) {
                const glm::dvec3 d = glm::dvec3(tensed[v]) - glm::dvec3(relaxed[v]);
                const double x = body.body.mesh.positions[v].x * (side ? -1.0 : 1.0);
                EXPECT_TRUE(glm::length(d) < 1e-6 || x > -0.02) << name;
                moved += d;
                sizes[side] = std::max(sizes[side], glm::length(d));
            }
            EXPECT_GT(glm::dot(glm::normalize(moved), muscle.way), 0.4) << name;
        }
        EXPECT_GT(sizes[0], 1e-3) << muscle.name;
        EXPECT_NEAR(sizes[1] / sizes[0], 1.0, 0.1) << muscle.name;
    }
}

TEST(Muscles, NoMoreAreMadeThanASkinHasRoomFor) {
    BindOptions options = withMuscles();
    for (int i = 0; i < 30; ++i)
        options.ownMuscles.push_back(
            {"Own" + std::to_string(i), "LeftForeArm", {}, {}, 0.1, 0.9, 0.1, 0.1});
    const MuscleBody body(options);
    EXPECT_LE(body.binding.correctives.joints.size(), Correctives::kMaxJoints);
    const auto isLeftOut = [&](const std::string& name) {
        return std::any_of(body.report.notes.begin(), body.report.notes.end(),
                           [&](const std::string& note) {
                               return note.find("muscle " + name + " is left out: a skin has") == 0;
                           });
    };
    EXPECT_FALSE(isLeftOut("Own0"));
    EXPECT_TRUE(isLeftOut("RightGluteus"));
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
