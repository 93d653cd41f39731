// SPDX-License-Identifier: GPL-3.0-or-later
//
// Limbs that bend without ballooning and without self-intersections.
//
// Meshes that are not surfaces: solving equations on their vertices took minutes, and gigabytes.
#include "KnownBody.h"
#include "Shapes.h"
#include "correctives/ShapedJoint.h"
#include "mesh/RequireSurface.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Deform>
#include <osgSkin/Error>
#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>
#include <osgSkinBind/FitSkeleton>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <utility>

using namespace osgSkin;

namespace {

Binding bound(const SkinMesh& mesh, const RestSkeleton& skeleton, BindOptions::Shapes shapes) {
    BindOptions options;
    options.shapes = shapes;
    return bind(mesh, skeleton, options);
}

/// The skin with one joint, and its descendants, rotated about its centre.
std::vector<glm::dvec3> turned(const SkinMesh& mesh, const RestSkeleton& skeleton,
                               const Binding& binding, std::size_t joint, const glm::dvec3& axis,
                               double degrees) {
    const glm::dvec3& centre = binding.joints[joint].centre;
    const glm::dmat4 unit(1.0);
    const glm::dmat4 turn = glm::translate(unit, centre) *
                            glm::rotate(unit, glm::radians(degrees), axis) *
                            glm::translate(unit, -centre);
    std::vector<glm::dmat4> skinning(binding.joints.size(), unit);
    for (std::size_t j = 0; j < skinning.size(); ++j)
        if (skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(joint))) skinning[j] = turn;
    return deform(binding, mesh.positions, skinning);
}

/// Measures of a cylinder along y of radius 1 that is bent at y = 4.
struct Fold {
    double outerLeast = 10.0, outerMost = 0.0; ///< distance to the bone, outer quarter
    double most = 0.0;                         ///< of the whole skin
    double past = 0.0;                         ///< how far skin lies past the bisector plane
};

Fold foldOf(const SkinMesh& mesh, const std::vector<glm::dvec3>& posed, const glm::dvec3& axis,
            double degrees) {
    const glm::dvec3 centre(0, 4, 0), a(0, 1, 0);
    const glm::dvec3 b =
        glm::dvec3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis) * glm::dvec4(a, 0.0));
    const glm::dvec3 n = glm::normalize(a + b), inwards = glm::normalize(b - a);
    const glm::dvec3 inwardsAtRest = glm::cross(axis, a);
    Fold fold;
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const glm::dvec3 x = posed[v] - centre, rest = mesh.positions[v] - centre;
        if (glm::length(glm::dvec2(rest.x, rest.z)) < 0.99 || std::abs(rest.y) > 3.0) continue;
        const glm::dvec3 m = glm::dot(x, n) < 0.0 ? -a : b;
        const double z = std::max(glm::dot(x, m), 0.0);
        const double d = std::sqrt(std::max(glm::dot(x, x) - z * z, 0.0));
        fold.most = std::max(fold.most, d);
        if (glm::dot(rest, inwardsAtRest) < -0.7) {
            fold.outerLeast = std::min(fold.outerLeast, d);
            fold.outerMost = std::max(fold.outerMost, d);
        }
        if (std::abs(rest.y) > 1e-9 && glm::dot(x, inwards) > 0.0)
            fold.past = std::max(fold.past, rest.y > 0.0 ? -glm::dot(x, n) : glm::dot(x, n));
    }
    return fold;
}

/// Area of a section through a cylinder's child side at a distance from its centre, relative to the
/// unit circle. The section has to be a closed curve.
double sectionOf(const SkinMesh& mesh, const std::vector<glm::dvec3>& posed,
                 const glm::dvec3& along, double distance) {
    double area = 0.0;
    // Measured from inside, so that no part of the curve counts as negative.
    const glm::dvec3 origin = glm::dvec3(0, 4, 0) + distance * along;
    const std::vector<std::uint32_t> corners = mesh.triangles();
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        const auto corner = [&](std::size_t i) { return corners[t + i % 3]; };
        if (mesh.positions[corner(0)].y + mesh.positions[corner(1)].y +
                mesh.positions[corner(2)].y <
            12.0)
            continue;
        std::vector<glm::dvec3> ends;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 a = posed[corner(i)] - origin, b = posed[corner(i + 1)] - origin;
            const double za = glm::dot(a, along), zb = glm::dot(b, along);
            if ((za < 0.0) != (zb < 0.0)) ends.push_back(a + za / (za - zb) * (b - a));
        }
        if (ends.size() == 2) area += 0.5 * std::abs(glm::dot(along, glm::cross(ends[0], ends[1])));
    }
    return area / glm::pi<double>();
}

double bendOf(const Binding& binding, std::size_t vertex, std::size_t joint) {
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i)
        if (binding.influences[i].joint == joint)
            return static_cast<double>(binding.influences[i].bend);
    return 0.0;
}

/// How far skin beside a joint that is bent by 130 degrees lies past the plane between both bones:
/// the mean of the deepest twentieth, in radii. The hinge is rotated about the bone above.
double pastOf(const KnownBody& body, const Binding& binding, std::size_t joint, double turn) {
    const CorrectiveJoint* functions = nullptr;
    const Binding shaped = bound(body.mesh, body.truth, BindOptions::Shapes::Fast);
    for (const CorrectiveJoint& each : shaped.correctives.joints)
        if (each.joint == joint) functions = &each;
    if (!functions) return 1e3;
    const glm::dvec3 centre = binding.joints[joint].centre, bone = binding.joints[joint].boneAxis;
    const auto limb = static_cast<std::size_t>(body.truth.joints[joint].parent);
    const glm::dvec3 above = glm::normalize(centre - body.truth.joints[limb].centre);
    const glm::dvec3 axis = glm::dvec3(glm::rotate(glm::dmat4(1.0), glm::radians(turn), above) *
                                       glm::dvec4(functions->axis, 0.0));
    const double degrees = 130.0 - glm::degrees(std::acos(glm::dot(above, bone)));
    const auto posed = turned(body.mesh, body.truth, binding, joint, axis, degrees);
    const glm::dvec3 bent = glm::dvec3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis) *
                                       glm::dvec4(bone, 0.0));
    const glm::dvec3 normal = glm::normalize(above + bent), inwards = bent - above;
    std::vector<double> radii, past;
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const double bend = bendOf(binding, v, joint);
        if (bend > 0.4 && bend < 0.6)
            radii.push_back(glm::length(glm::cross(body.mesh.positions[v] - centre, bone)));
    }
    std::nth_element(radii.begin(), radii.begin() + std::ptrdiff_t(radii.size() / 2), radii.end());
    const double radius = radii[radii.size() / 2];
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const glm::dvec3 rest = body.mesh.positions[v] - centre, x = posed[v] - centre;
        const double side = glm::dot(rest, glm::normalize(above + bone));
        if (glm::length(rest) > 3.0 * radius || std::abs(side) < 0.1 * radius) continue;
        if (glm::dot(x, inwards) < 0.0 || bendOf(binding, v, limb) < 0.9) continue;
        past.push_back(std::max(0.0, std::copysign(1.0, side) * -glm::dot(x, normal)) / radius);
    }
    std::sort(past.rbegin(), past.rend());
    const auto deepest = std::max<std::size_t>(1, past.size() / 20);
    return std::accumulate(past.begin(), past.begin() + std::ptrdiff_t(deepest), 0.0) /
           double(deepest);
}

/// How far skin that follows a joint in part swells from the joint's bone when it bends: the mean,
/// in bone lengths.
double swellingOf(const KnownBody& body, const Binding& binding, std::size_t joint,
                  const glm::dvec3& axis, double degrees) {
    const std::vector<glm::dvec3> posed =
        turned(body.mesh, body.truth, binding, joint, axis, degrees);
    const glm::dvec3& centre = binding.joints[joint].centre;
    const glm::dvec3& bone = binding.joints[joint].boneAxis;
    const glm::dvec3 bent = glm::dvec3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis) *
                                       glm::dvec4(bone, 0.0));
    const auto distance = [](const glm::dvec3& from, const glm::dvec3& along) {
        return glm::length(from - std::max(glm::dot(from, along), 0.0) * along);
    };
    double sum = 0.0, count = 0.0;
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const double bend = bendOf(binding, v, joint);
        if (bend < 0.3 || bend > 0.9) continue;
        const double swollen =
            distance(posed[v] - centre, bent) - distance(body.mesh.positions[v] - centre, bone);
        sum += std::max(swollen, 0.0);
        ++count;
    }
    return sum / count;
}

} // namespace

TEST(FastShapes, AreTheDefaultOfSmoothRatiosWithTheNormalsOfTheSurface) {
    const SkinMesh mesh = shapes::cylinder(8.0, 16);
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    const Binding smooth = bind(mesh, skeleton);
    EXPECT_EQ(bound(mesh, skeleton, BindOptions::Shapes::Fast).correctives.shares,
              smooth.correctives.shares);
    EXPECT_FALSE(smooth.correctives.empty());
    EXPECT_FALSE(smooth.gradients.empty());
    EXPECT_TRUE(bound(mesh, skeleton, BindOptions::Shapes::None).correctives.empty());

    BindOptions paper;
    paper.method = BindOptions::Method::Paper;
    const VertexWeights weights(mesh.positions.size(), {{0, 0.5}, {1, 0.5}});
    for (const Binding& as : {bind(mesh, skeleton, paper), bindWeights(mesh, skeleton, weights)}) {
        EXPECT_TRUE(as.correctives.empty());
        EXPECT_TRUE(as.gradients.empty());
    }
}

TEST(FastShapes, CylinderKeepsItsOuterSideAndDoesNotFoldThroughItself) {
    const SkinMesh mesh = shapes::cylinder(8.0, 48);
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    const Binding plain = bound(mesh, skeleton, BindOptions::Shapes::None);
    const Binding shaped = bound(mesh, skeleton, BindOptions::Shapes::Fast);
    for (const double azimuth : {0.0, 40.0, 100.0}) {
        const glm::dvec3 axis(std::cos(glm::radians(azimuth)), 0.0,
                              std::sin(glm::radians(azimuth)));
        for (double degrees = 30.0; degrees <= 150.0; degrees += 30.0) {
            SCOPED_TRACE(degrees);
            const Fold fold =
                foldOf(mesh, turned(mesh, skeleton, shaped, 1, axis, degrees), axis, degrees);
            EXPECT_GE(fold.outerLeast, 0.94);
            EXPECT_LE(fold.outerMost, degrees < 140.0 ? 1.03 : 1.22);
            // Deep folds widen the flanks, since the volume has to go somewhere.
            EXPECT_LE(fold.most, degrees < 140.0 ? 1.06 : 1.38);
            EXPECT_LE(fold.past, 0.05);
        }
        const Fold without =
            foldOf(mesh, turned(mesh, skeleton, plain, 1, axis, 150.0), axis, 150.0);
        EXPECT_GE(without.outerMost, 1.2);
        EXPECT_GE(without.past, 0.3);
    }
}

TEST(FastShapes, KeepTheSectionsBesideAJoint) {
    const SkinMesh mesh = shapes::cylinder(10.0, 48);
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 10.0);
    const Binding shaped = bound(mesh, skeleton, BindOptions::Shapes::Fast);
    const std::pair<double, double> cases[] = {{60.0, 0.92}, {90.0, 0.88}, {120.0, 0.82}};
    for (const auto& [degrees, least] : cases)
        for (const double distance : {1.5, 2.0, 3.0}) {
            SCOPED_TRACE(std::to_string(degrees) + " degrees, " + std::to_string(distance));
            const auto posed = turned(mesh, skeleton, shaped, 1, {1, 0, 0}, degrees);
            const glm::dvec3 bone(0.0, std::cos(glm::radians(degrees)),
                                  std::sin(glm::radians(degrees)));
            const double section = sectionOf(mesh, posed, bone, distance);
            EXPECT_GE(section, least);
            EXPECT_LE(section, 1.1);
        }
}

// A knee whose axis is rotated about the thigh folds no deeper into itself than a straight one.
TEST(FastShapes, ClearFoldsAboutTurnedAxes) {
    const KnownBody body = KnownBody::thrower();
    const Binding plain = bound(body.mesh, body.truth, BindOptions::Shapes::None);
    const Binding shaped = bound(body.mesh, body.truth, BindOptions::Shapes::Fast);
    for (const char* name : {"LeftLeg", "RightForeArm"})
        for (const double turn : {-20.0, 0.0, 20.0}) {
            SCOPED_TRACE(std::string(name) + " turned by " + std::to_string(turn));
            const auto joint = static_cast<std::size_t>(body.truth.find(name));
            EXPECT_GE(pastOf(body, plain, joint, turn), 0.15);
            EXPECT_LE(pastOf(body, shaped, joint, turn), 0.1);
        }
}

TEST(FastShapes, FindLimbsByName) {
    using Basis = CorrectiveJoint::Basis;
    const KnownBody body = KnownBody::thrower();
    const Binding binding = bound(body.mesh, body.truth, BindOptions::Shapes::Fast);
    std::map<std::string, Basis> found;
    for (const CorrectiveJoint& joint : binding.correctives.joints)
        found[binding.joints[joint.joint].name] = joint.basis;
    const std::map<std::string, Basis> expected = {{"LeftForeArm", Basis::TurnedHinge},
                                                   {"RightForeArm", Basis::TurnedHinge},
                                                   {"LeftLeg", Basis::TurnedHinge},
                                                   {"RightLeg", Basis::TurnedHinge},
                                                   {"LeftArm", Basis::Ball},
                                                   {"RightArm", Basis::Ball},
                                                   {"LeftUpLeg", Basis::Ball},
                                                   {"RightUpLeg", Basis::Ball},
                                                   {"LeftHand", Basis::Ball},
                                                   {"RightHand", Basis::Ball},
                                                   {"LeftFoot", Basis::Ball},
                                                   {"RightFoot", Basis::Ball},
                                                   {"LeftShoulder", Basis::Ball},
                                                   {"RightShoulder", Basis::Ball},
                                                   {"Neck", Basis::Ball},
                                                   {"Neck1", Basis::Ball}};
    EXPECT_EQ(found, expected);
}

TEST(FastShapes, LeaveFingersToesAndTheHeadAlone) {
    const KnownBody body = KnownBody::thrower();
    BindOptions options;
    options.rigid.emplace(); // none: fingers and toes bend
    const Binding binding = bind(body.mesh, body.truth, options);
    for (const CorrectiveJoint& joint : binding.correctives.joints) {
        const std::string& moved = binding.joints[joint.joint].name;
        EXPECT_NE(moved, "Head");
        for (const char* name : {"LeftHand", "RightHand", "LeftFoot", "RightFoot", "Head"})
            EXPECT_FALSE(moved != name && body.truth.isInSubtree(static_cast<int>(joint.joint),
                                                                 body.truth.find(name)))
                << moved;
    }
}

// Where a limb's skin is halfway between the bones, it follows the bent bone's direction.
TEST(FastShapes, SkinSlidesAlongWithKnownLimbs) {
    KnownBody body = KnownBody::thrower();
    const auto slideOf = [&body](const char* name) {
        const Binding plain = bound(body.mesh, body.truth, BindOptions::Shapes::None);
        const Binding shaped = bound(body.mesh, body.truth, BindOptions::Shapes::Fast);
        const auto joint = static_cast<std::size_t>(body.truth.find(name));
        const glm::dvec3 axis(1, 0, 0);
        const auto from = turned(body.mesh, body.truth, plain, joint, axis, -60.0);
        const auto to = turned(body.mesh, body.truth, shaped, joint, axis, -60.0);
        const glm::dvec3 bone = plain.joints[joint].boneAxis;
        const glm::dvec3 bent(glm::rotate(glm::dmat4(1.0), glm::radians(-60.0), axis) *
                              glm::dvec4(bone, 0.0));
        double sum = 0.0, count = 0.0;
        for (std::size_t v = 0; v < from.size(); ++v) {
            const double ratio = bendOf(plain, v, joint);
            if (ratio < 0.4 || ratio > 0.6) continue;
            sum += glm::dot(to[v] - from[v], glm::normalize(bent - bone));
            count += 1.0;
        }
        return sum / count;
    };
    for (const char* name : {"LeftUpLeg", "LeftFoot", "Neck"})
        EXPECT_GT(slideOf(name), 0.0) << name;
}

// How far shapes move skin in front of a knee changes little from one vertex to the next.
TEST(FastShapes, AKneecapDoesNotFold) {
    const KnownBody body = KnownBody::shared("body4k_male", "cmu_mb_male");
    if (body.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    const Binding plain = bound(body.mesh, body.truth, BindOptions::Shapes::None);
    const Binding shaped = bound(body.mesh, body.truth, BindOptions::Shapes::Fast);
    const auto knee = static_cast<std::size_t>(body.truth.find("LeftLeg"));
    const glm::dvec3 axis(1, 0, 0), centre = plain.joints[knee].centre;
    const auto from = turned(body.mesh, body.truth, plain, knee, axis, 130.0);
    const auto to = turned(body.mesh, body.truth, shaped, knee, axis, 130.0);
    const std::vector<std::uint32_t> corners = body.mesh.triangles();
    double most = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::uint32_t a = corners[i], b = corners[i % 3 == 2 ? i - 2 : i + 1];
        const glm::dvec3 at = body.mesh.positions[a] - centre;
        if (at.z < 0.1 || glm::length(at) > 0.8) continue;
        most = std::max(most, glm::distance(to[a] - from[a], to[b] - from[b]) /
                                  glm::distance(body.mesh.positions[a], body.mesh.positions[b]));
    }
    EXPECT_GT(most, 0.1);
    EXPECT_LT(most, 0.75);
}

// A stubby arm's skin would slide over the whole shoulder.
TEST(FastShapes, SkinOfStubbyArmsSlidesLess) {
    const auto slideOf = [](double girth) {
        const KnownBody body = KnownBody::thrower().mapped([girth](const glm::dvec3& p) {
            return glm::dvec3(p.x, girth * p.y, girth * p.z); // arms are along x
        });
        std::vector<std::string> notes;
        const WeldedMesh mesh(body.mesh);
        const Binding plain = bound(body.mesh, body.truth, BindOptions::Shapes::None);
        for (const ShapedJoint& joint :
             findShapedJoints(body.truth, planJoints(body.truth, mesh, {}, notes), mesh, plain))
            if (body.truth.joints[joint.functions.joint].name == "LeftArm") return joint.slide;
        return 0.0;
    };
    const double adult = slideOf(1.0);
    EXPECT_GT(adult, 0.3);
    EXPECT_LT(slideOf(1.3), 0.95 * adult);
    EXPECT_LT(slideOf(1.6), 0.8 * adult);
}

TEST(FastShapes, ShouldersAndHipsSwellLess) {
    const KnownBody body = KnownBody::thrower();
    const Binding plain = bound(body.mesh, body.truth, BindOptions::Shapes::None);
    const Binding shaped = bound(body.mesh, body.truth, BindOptions::Shapes::Fast);
    for (const char* name : {"LeftArm", "RightUpLeg"}) {
        SCOPED_TRACE(name);
        const auto joint = static_cast<std::size_t>(body.truth.find(name));
        double before = 0.0, after = 0.0;
        for (const glm::dvec3& axis : {glm::dvec3(0, 0, 1), {0, 0, -1}, {-1, 0, 0}}) {
            before += swellingOf(body, plain, joint, axis, 80.0);
            after += swellingOf(body, shaped, joint, axis, 80.0);
        }
        EXPECT_GT(before, 0.0);
        EXPECT_LE(after, 0.75 * before);
    }
}

TEST(FastShapes, FindLimbsOfARigThatNobodyKnows) {
    KnownBody body = KnownBody::thrower();
    using Basis = CorrectiveJoint::Basis;
    const std::map<int, bool> limbs = {// value: whether it joins the trunk
                                       {body.truth.find("LeftForeArm"), false},
                                       {body.truth.find("RightLeg"), false},
                                       {body.truth.find("LeftArm"), true},
                                       {body.truth.find("RightUpLeg"), true}};
    for (std::size_t j = 0; j < body.truth.joints.size(); ++j)
        body.truth.joints[j].name = "n" + std::to_string(j);
    const Binding binding = bound(body.mesh, body.truth, BindOptions::Shapes::Fast);
    std::map<int, bool> found;
    for (const CorrectiveJoint& joint : binding.correctives.joints)
        found[static_cast<int>(joint.joint)] = joint.basis == Basis::Ball;
    for (const auto& [limb, atTrunk] : limbs) {
        ASSERT_EQ(found.count(limb), 1u) << limb;
        EXPECT_EQ(found[limb], atTrunk) << limb;
    }
}

TEST(FastShapes, LeaveTheSeamsOfRigidPartsAlone) {
    const KnownBody body = KnownBody::thrower();
    const Binding binding = bound(body.mesh, body.truth, BindOptions::Shapes::Fast);
    std::size_t rigid = 0;
    for (const char* name : {"LeftHand", "RightHand", "LeftFoot", "RightFoot"}) {
        const auto joint = static_cast<std::size_t>(body.truth.find(name));
        for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
            if (bendOf(binding, v, joint) < 1.0) continue;
            ++rigid;
            EXPECT_EQ(binding.correctives.firstEntry[v], binding.correctives.firstEntry[v + 1])
                << "moved by "
                << binding
                       .joints[binding.correctives
                                   .joints[binding.correctives
                                               .entries[binding.correctives.firstEntry[v]]
                                               .joint]
                                   .joint]
                       .name;
        }
    }
    EXPECT_GE(rigid, 100u);
}

TEST(FastShapes, MoveCopiesOfAVertexAlike) {
    const SkinMesh mesh = shapes::exploded(shapes::cylinder(8.0, 12));
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    const Binding binding = bound(mesh, skeleton, BindOptions::Shapes::Fast);
    const auto posed = turned(mesh, skeleton, binding, 1, {1, 0, 0}, 100.0);
    for (std::size_t a = 0; a < posed.size(); ++a)
        for (std::size_t b = a + 1; b < std::min(posed.size(), a + 60); ++b)
            if (mesh.positions[a] == mesh.positions[b]) {
                EXPECT_LE(glm::distance(posed[a], posed[b]), 1e-5);
            }
}

namespace {

/// Triangles between random vertices, around the cylinder of shapes::cylinder().
SkinMesh trianglesAtRandom(std::uint32_t vertices, std::size_t triangles) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    std::uniform_int_distribution<std::uint32_t> vertex(0, vertices - 1);
    SkinMesh mesh;
    for (std::uint32_t v = 0; v < vertices; ++v)
        mesh.positions.emplace_back(place(random), 4.0 + 4.0 * place(random), place(random));
    for (std::size_t t = 0; t < triangles; ++t) {
        const std::uint32_t a = vertex(random), b = vertex(random), c = vertex(random);
        if (a == b || b == c || c == a) continue;
        mesh.faceSizes.push_back(3);
        mesh.faceVertices.insert(mesh.faceVertices.end(), {a, b, c});
    }
    return mesh;
}

void expectRefused(const SkinMesh& mesh, const char* part) {
    const std::clock_t begin = std::clock();
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    const auto complaint = [&](const auto& step) -> std::string {
        try {
            step();
            return "none";
        } catch (const Error& error) {
            return error.what();
        }
    };
    EXPECT_NE(complaint([&] { bind(mesh, skeleton); }).find(part), std::string::npos);
    BindOptions paper;
    paper.method = BindOptions::Method::Paper;
    EXPECT_NE(complaint([&] { bind(mesh, skeleton, paper); }).find(part), std::string::npos);
    EXPECT_NE(complaint([&] { fitSkeleton(mesh); }).find(part), std::string::npos);
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 6.0); // with sanitizers, too
}

} // namespace

TEST(Surface, TrianglesAtRandomAreNone) {
    expectRefused(trianglesAtRandom(1500, 4500),
                  "triangles of 1500 vertices join vertices all over the mesh, expected a surface");
    expectRefused(trianglesAtRandom(160, 8000), "expected at most 12 for each vertex");
}

TEST(Surface, ManySmallOnesOfNoKindAreNone) {
    SkinMesh all = trianglesAtRandom(100, 300);
    for (int i = 0; i < 40; ++i)
        all = shapes::joined(all, shapes::moved(trianglesAtRandom(100, 300), {0.0, 1e-3 * i, 0.0}));
    expectRefused(all, "expected a surface");
}

TEST(Surface, FacesOfAllCellsOfASolidAreNone) {
    constexpr std::uint32_t kSide = 24;
    const auto corner = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return x + kSide * (y + kSide * z);
    };
    SkinMesh mesh;
    for (std::uint32_t i = 0; i < kSide * kSide * kSide; ++i)
        mesh.positions.emplace_back(i % kSide, i / kSide % kSide, i / kSide / kSide);
    for (std::uint32_t z = 0; z + 1 < kSide; ++z)
        for (std::uint32_t y = 0; y + 1 < kSide; ++y)
            for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
                const std::uint32_t a = corner(x, y, z), b = corner(x + 1, y, z);
                mesh.faceSizes.insert(mesh.faceSizes.end(), {4, 4});
                mesh.faceVertices.insert(mesh.faceVertices.end(),
                                         {a, b, corner(x + 1, y + 1, z), corner(x, y + 1, z), a, b,
                                          corner(x + 1, y, z + 1), corner(x, y, z + 1)});
            }
    expectRefused(mesh, "expected a surface");
}

/// Surfaces that are unlike a body, but valid.
TEST(Surface, BallsAndRingsAndSieves) {
    const auto isSurface = [](const shapes::Filled& filled, int range) {
        const WeldedMesh mesh(shapes::voxelSurface(filled, range, 0.25));
        EXPECT_GT(mesh.vertexCount(), 1000u);
        EXPECT_NO_THROW(requireSurface(mesh)) << mesh.vertexCount();
    };
    const auto ball = [](int radius) {
        return [radius](int x, int y, int z) { return x * x + y * y + z * z < radius * radius; };
    };
    isSurface(ball(10), 12);
    isSurface(ball(40), 44);
    isSurface(
        [](int x, int y, int z) {
            const int aside = x * x + y * y;
            return aside > 20 * 20 && aside < 30 * 30 && z * z < 25;
        },
        32);
    isSurface( // a plate with 64 holes
        [](int x, int y, int z) { return (x % 5 != 0 || y % 5 != 0) && z >= -2 && z < 2; }, 20);
}

TEST(ShapeReach, FallsFromOneToZero) {
    const ShapeReach reach{2.0, 4.0};
    EXPECT_EQ(reach.shareAt(0.0), 1.0);
    EXPECT_EQ(reach.shareAt(2.0), 1.0);
    EXPECT_NEAR(reach.shareAt(3.0), 0.5, 1e-12);
    EXPECT_EQ(reach.shareAt(4.0), 0.0);
    EXPECT_EQ(reach.shareAt(9.0), 0.0);
    for (double r = 2.0; r < 4.0; r += 0.1) EXPECT_GE(reach.shareAt(r), reach.shareAt(r + 0.1));
}

/// An arm whose forearm has a second bone in line with the first, for twists.
TEST(FindShapedJoints, LeavesOutTwistBones) {
    RestSkeleton skeleton;
    skeleton.add("Spine", -1, glm::dvec3(0, 0, 0));
    skeleton.add("LeftArm", 0, glm::dvec3(0, 1, 0));
    skeleton.add("LeftForeArm", 1, glm::dvec3(0, 5, 0.5));
    skeleton.add("LeftForeArmRoll", 2, glm::dvec3(0, 8.6, 0.25));
    skeleton.add("LeftHand", 3, glm::dvec3(0, 12.2, 0.0));
    skeleton.joints.back().tip = glm::dvec3(0, 14, -0.125);
    std::vector<std::uint32_t> shaped;
    for (const CorrectiveJoint& joint :
         bind(shapes::cylinder(14.0, 16), skeleton).correctives.joints)
        shaped.push_back(joint.joint);
    EXPECT_EQ(std::count(shaped.begin(), shaped.end(), 2u), 1) << "the elbow";
    EXPECT_EQ(std::count(shaped.begin(), shaped.end(), 3u), 0) << "the twist bone";
}
