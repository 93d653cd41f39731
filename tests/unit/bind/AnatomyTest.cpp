// SPDX-License-Identifier: GPL-3.0-or-later
//
// The tissue below the skin of people's joints.
#include "correctives/Anatomy.h"

#include "KnownBody.h"
#include "Shapes.h"
#include "garments/SkinLayers.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

using namespace osgSkin;

namespace {

/// A joint of the thrower without its tissues.
class JointOfThrower {
public:
    explicit JointOfThrower(const char* name, KnownBody known = KnownBody::thrower())
        : body(std::move(known)), mesh(body.mesh) {
        std::vector<std::string> notes;
        BindOptions options;
        options.shapes = BindOptions::Shapes::None;
        joints = planJoints(body.truth, mesh, options, notes);
        const Binding binding = bind(body.mesh, body.truth, options);
        for (ShapedJoint& joint : findShapedJoints(body.truth, joints, mesh, binding))
            if (body.truth.joints[joint.functions.joint].name == name) shaped = std::move(joint);
    }

    void addTissue(const SkinLayers* layers = nullptr) {
        addTissues(recogniseJoints(body.truth), joints, mesh, layers, shaped);
    }

    /// A bend about an axis of rest space, perpendicular to the joint's twist axis or made so.
    BendTwist bend(const glm::dvec3& axis, double degrees) const {
        BendTwist bend;
        bend.bendAxis = glm::normalize(axis - shaped.twistAxis * glm::dot(axis, shaped.twistAxis));
        bend.bendAngle = glm::radians(degrees);
        return bend;
    }

    KnownBody body;
    WeldedMesh mesh;
    std::vector<PlannedJoint> joints;
    ShapedJoint shaped;
};

/// How far tissues move the skin outwards above the kneecap, in radii: the most of it.
double aboveKneecap(const JointOfThrower& knee, double degrees) {
    const ShapedJoint& shaped = knee.shaped;
    std::vector<glm::dvec3> rest;
    for (const ShapedJoint::Vertex& vertex : shaped.vertices) rest.push_back(vertex.from);
    const std::vector<glm::dvec3> displaced = displacedByTissues(
        shaped, rest, knee.bend(shaped.functions.axis, degrees), SkinRelaxation(shaped));
    const glm::dvec3 front = -glm::normalize(glm::cross(shaped.functions.axis, shaped.bone));
    double most = 0.0;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const double along = glm::dot(rest[v], shaped.above) / shaped.radius;
        if (along > -1.0 || along < -1.6) continue;
        most = std::max(most, glm::dot(displaced[v] - rest[v], front) / shaped.radius);
    }
    return most;
}

} // namespace

TEST(Anatomy, ABentKneeKeepsTheThighFullAboveTheKneecap) {
    JointOfThrower knee("LeftLeg");
    ASSERT_FALSE(knee.shaped.vertices.empty());
    EXPECT_EQ(aboveKneecap(knee, 90.0), 0.0);
    knee.addTissue();
    EXPECT_EQ(aboveKneecap(knee, 0.0), 0.0);
    const double square = aboveKneecap(knee, 90.0);
    EXPECT_GT(square, 0.1);
    EXPECT_LT(square, 0.3);
    EXPECT_GT(aboveKneecap(knee, 120.0), square);
    EXPECT_NEAR(aboveKneecap(knee, 150.0), aboveKneecap(knee, 170.0), 0.02); // constant
}

TEST(Anatomy, AThighInFrontKeepsTheButtockFull) {
    JointOfThrower hip("LeftUpLeg");
    ASSERT_FALSE(hip.shaped.vertices.empty());
    hip.addTissue();
    ASSERT_EQ(hip.shaped.tissues.size(), 1u);
    const ShapedJoint::Tissue& buttock = hip.shaped.tissues.front();
    const auto forward = [&](double degrees) { // of the rest pose
        return buttock.amount(hip.bend({-1, 0, 0}, degrees));
    };
    EXPECT_NEAR(forward(0.0), 0.0, 1e-12);
    EXPECT_GT(forward(30.0), 0.0);
    EXPECT_GT(forward(60.0), forward(30.0));
    EXPECT_NEAR(forward(-20.0), 0.0, 0.02); // backwards
    EXPECT_NEAR(forward(150.0), forward(170.0), 1e-9);
    const auto most = std::max_element(
        buttock.moves.begin(), buttock.moves.end(),
        [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a) < glm::length(b); });
    const glm::dvec3 at =
        hip.shaped.vertices[static_cast<std::size_t>(most - buttock.moves.begin())].from;
    EXPECT_GT(glm::dot(*most, at), 0.0); // outwards
    EXPECT_GT(at.x, 0.0);                // outside, on the left
    EXPECT_LT(at.z, 0.0);                // behind
    EXPECT_GT(glm::length(*most), 0.15 * hip.shaped.radius);
    EXPECT_LT(glm::length(*most), 0.4 * hip.shaped.radius);
}

TEST(Anatomy, AnArmInFrontCountsFromTheHangingArm) {
    JointOfThrower shoulder("LeftArm");
    ASSERT_FALSE(shoulder.shaped.vertices.empty());
    shoulder.addTissue();
    ASSERT_EQ(shoulder.shaped.tissues.size(), 2u);
    const auto at = [&](std::size_t tissue, const glm::dvec3& bone) { // posed
        const glm::dvec3& rest = shoulder.shaped.bone;
        const double degrees = glm::degrees(std::acos(glm::dot(rest, bone)));
        return shoulder.shaped.tissues[tissue].amount(
            shoulder.bend(glm::cross(rest, bone), degrees));
    };
    EXPECT_GT(at(0, {0, 0, 1}), 0.5);
    EXPECT_NEAR(at(0, {0, -1, 0}), at(1, {0, -1, 0}), 0.05); // none when it hangs
    EXPECT_GT(at(1, glm::normalize(glm::dvec3(-0.7, 0, 0.7))), at(1, {0, 0, 1}));
}

TEST(Anatomy, ClothMovesWithTheSkinBelow) {
    KnownBody body = KnownBody::thrower();
    const std::size_t naked = body.mesh.positions.size();
    SkinMesh trousers = shapes::garment(
        body.mesh, [](const glm::dvec3& p) { return p.y > 0.15 && p.y < 1.0; }, 0.014);
    for (std::size_t v = 0; v < trousers.positions.size(); v += 2) // wrinkled
        trousers.positions[v].y += 0.006;
    body.mesh = shapes::joined(body.mesh, trousers);
    JointOfThrower knee("LeftLeg", body);
    ASSERT_FALSE(knee.shaped.vertices.empty());
    findExtremities(knee.mesh, knee.joints);
    const SkinLayers layers(knee.mesh, knee.joints, findRegions(knee.mesh, knee.joints, {}));
    // How differently cloth and the nearest skin move, over the most that skin moves.
    const auto apart = [&](const SkinLayers* on) {
        knee.shaped.tissues.clear();
        knee.addTissue(on);
        const std::vector<glm::dvec3>& moves = knee.shaped.tissues.front().moves;
        const auto indexOf = [&](std::size_t i) { return knee.shaped.vertices[i].index; };
        double most = 0.0, differ = 0.0;
        for (std::size_t i = 0; i < moves.size(); ++i) {
            most = std::max(most, glm::length(moves[i]));
            if (indexOf(i) < naked) continue;
            std::size_t below = 0;
            double nearest = 1e9;
            for (std::size_t k = 0; k < moves.size() && indexOf(k) < naked; ++k) {
                const double distance =
                    glm::distance(knee.mesh.positions[indexOf(k)], knee.mesh.positions[indexOf(i)]);
                if (distance < nearest) nearest = distance, below = k;
            }
            differ = std::max(differ, glm::distance(moves[i], moves[below]));
        }
        return differ / most;
    };
    EXPECT_LT(apart(&layers), 0.12);
    EXPECT_GT(apart(nullptr), 0.18);
}

TEST(Anatomy, OnlyPeoplesLimbsHaveIt) {
    KnownBody body = KnownBody::thrower();
    const int knee = body.truth.find("LeftLeg");
    for (std::size_t j = 0; j < body.truth.joints.size(); ++j)
        body.truth.joints[j].name = "n" + std::to_string(j);
    JointOfThrower unknown(("n" + std::to_string(knee)).c_str(), body);
    ASSERT_FALSE(unknown.shaped.vertices.empty());
    unknown.addTissue();
    EXPECT_TRUE(unknown.shaped.tissues.empty());

    JointOfThrower stubby("LeftLeg");
    stubby.shaped.radius = stubby.joints[stubby.shaped.functions.joint].boneLength / 3.0;
    stubby.addTissue();
    EXPECT_TRUE(stubby.shaped.tissues.empty());
}
