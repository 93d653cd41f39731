// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes of tubes, intact ones first, and of a real body's elbow.
#include "ElasticTube.h"
#include "Shapes.h"
#include "SharedBody.h"
#include "elastic/CountCrossings.h"
#include "elastic/SolveElastic.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

using namespace osgSkin;

namespace {

/// Pairs of intersecting triangles of a skin whose vertices are rotated by their ratios.
std::size_t plainCrossings(const ElasticSkin& skin, const ElasticJoint& joint,
                           const glm::dquat& rotation) {
    elastic::Points posed(3, static_cast<Eigen::Index>(skin.positions.size()));
    for (std::size_t v = 0; v < skin.positions.size(); ++v) {
        const glm::dquat own =
            glm::angleAxis(joint.ratios[v] * glm::angle(rotation), glm::axis(rotation));
        const glm::dvec3 p = own * (skin.positions[v] - joint.centre);
        posed.col(static_cast<Eigen::Index>(v)) << p.x, p.y, p.z;
    }
    return elastic::countCrossings(skin.triangles, posed);
}

/// Solved once for all tests, which only read it.
const ElasticShapes& bent() {
    static const ElasticTube tube;
    static const ElasticShapes shapes =
        solveElasticJoint(tube.skin(), tube.joint({30, 60, 90, 120}));
    return shapes;
}

} // namespace

TEST(ElasticCylinder, IsSolvedWithoutCrossingsOrInvertedCells) {
    ASSERT_EQ(bent().reason, "");
    ASSERT_EQ(bent().samples.size(), 4u);
    for (const ElasticSample& sample : bent().samples) {
        EXPECT_EQ(sample.reason, "");
        EXPECT_EQ(sample.crossings, 0u);
        EXPECT_GT(sample.leastJacobian, 0.0);
        EXPECT_EQ(sample.positions.size(), bent().vertices.size());
    }
    const ElasticTube tube; // else there was nothing to solve
    EXPECT_GT(plainCrossings(tube.skin(), tube.joint({}), bent().samples.back().rotation), 20u);
}

TEST(ElasticCylinder, KeepsItsVolume) {
    for (const ElasticSample& sample : bent().samples) {
        EXPECT_GT(sample.volumeRatio, 0.97);
        EXPECT_LT(sample.volumeRatio, 1.01);
    }
}

TEST(ElasticCylinder, OuterSideNeitherCavesInNorSwells) {
    const int angles[] = {30, 60, 90, 120};
    for (std::size_t i = 0; i < 4; ++i) {
        // Towards the outer side: the child's bone rotates from +y to +z.
        const double half = glm::radians(0.5 * angles[i]);
        const glm::dvec3 bone(0, std::cos(2.0 * half), std::sin(2.0 * half));
        const glm::dvec3 outwards(0, std::sin(half), -std::cos(half));
        double least = 1e9, most = 0.0;
        for (const glm::dvec3& p : bent().samples[i].positions) {
            const double height = glm::dot(p, glm::cross(outwards, glm::dvec3(1, 0, 0)));
            if (glm::dot(p, outwards) < 0.0 || std::abs(p.x) > 0.3 || std::abs(height) > 1.0)
                continue;
            const double below = glm::length(p - glm::dvec3(0, std::min(p.y, 0.0), 0));
            const double above = glm::length(p - std::max(glm::dot(p, bone), 0.0) * bone);
            least = std::min({least, below, above});
            most = std::max(most, std::min(below, above));
        }
        EXPECT_GT(least, 0.94) << angles[i];
        EXPECT_LT(most, 1.04) << angles[i];
    }
}

TEST(ElasticCylinder, ComesToTheSameFoldByAnyWay) {
    const ElasticTube tube;
    const ElasticShapes other = solveElasticJoint(tube.skin(), tube.joint({20, 50, 75, 98, 120}));
    const ElasticSample &a = bent().samples.back(), &b = other.samples.back();
    ASSERT_EQ(a.positions.size(), b.positions.size());
    for (std::size_t v = 0; v < a.positions.size(); ++v)
        EXPECT_LT(glm::length(a.positions[v] - b.positions[v]), 0.05);
}

/// For a bend that is too far, samples on the way to it are solved, so that functions can be
/// fitted.
TEST(ElasticCylinder, GoesPartOfTheWayToABendThatIsTooFar) {
    const ElasticTube tube;
    const ElasticShapes shapes = solveElasticJoint(tube.skin(), tube.joint({90, 178}));
    ASSERT_GT(shapes.samples.size(), 2u);
    EXPECT_EQ(shapes.samples[0].reason, "");
    EXPECT_NE(shapes.samples[1].reason, "");
    double last = glm::radians(90.0);
    for (std::size_t i = 2; i < shapes.samples.size(); ++i) {
        EXPECT_EQ(shapes.samples[i].reason, "");
        const double angle = glm::angle(shapes.samples[i].rotation);
        EXPECT_GT(angle, last + 0.1);
        EXPECT_LT(angle, glm::radians(170.0));
        last = angle;
    }
}

/// The tube, its bones and its bends, rotated about an oblique axis.
TEST(ElasticCylinder, HasTheSameShapesWhenTheBodyIsRotated) {
    ElasticTube tube;
    ElasticJoint joint = tube.joint({60, 90, 120});
    const glm::dquat turn = glm::angleAxis(glm::radians(20.0), glm::normalize(glm::dvec3(1, 2, 3)));
    for (glm::dvec3& p : tube.positions) p = turn * p;
    for (ElasticBone& bone : joint.bones) bone = {turn * bone.from, turn * bone.to, bone.moves};
    for (glm::dquat& sample : joint.samples) sample = turn * sample * glm::conjugate(turn);
    const ElasticShapes shapes = solveElasticJoint(tube.skin(), joint);
    ASSERT_EQ(shapes.vertices, bent().vertices);
    ASSERT_EQ(shapes.samples.size(), 3u);
    for (std::size_t s = 0; s < 3; ++s) {
        double sum = 0.0;
        for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
            const glm::dvec3 off = glm::conjugate(turn) * shapes.samples[s].positions[v] -
                                   bent().samples[s + 1].positions[v];
            sum += glm::dot(off, off);
        }
        EXPECT_LT(std::sqrt(sum / double(shapes.vertices.size())), 0.02) << s;
    }
}

TEST(ElasticCylinder, RimFollowsTheBones) {
    const ElasticShapes& shapes = bent();
    const double rim = shapes.reach - 1.0 / 3.0; // a cell
    std::size_t above = 0, below = 0;
    for (const ElasticSample& sample : shapes.samples)
        for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
            const glm::dvec3& rest = shapes.rest[v];
            if (glm::length(rest) < rim + 0.1) continue;
            const glm::dvec3 moved = rest.y > 0.0 ? sample.rotation * rest : rest;
            // Ratios within the flesh approach 0 and 1, but do not reach them.
            EXPECT_LT(glm::length(sample.positions[v] - moved), 1e-4);
            ++(rest.y > 0.0 ? above : below);
        }
    EXPECT_GT(above, 40u);
    EXPECT_GT(below, 40u);
}

TEST(ElasticCylinder, RestPoseIsTheRestSkin) {
    const ElasticTube tube;
    ElasticJoint joint = tube.joint({0});
    joint.samples.push_back(glm::angleAxis(1e-5, glm::dvec3(1, 0, 0))); // is minimised
    const ElasticShapes shapes = solveElasticJoint(tube.skin(), joint);
    ASSERT_EQ(shapes.samples.size(), 2u);
    EXPECT_GT(shapes.samples[1].steps, 0);
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
        EXPECT_LT(glm::length(shapes.samples[0].positions[v] - shapes.rest[v]), 1e-9);
        EXPECT_LT(glm::length(shapes.samples[1].positions[v] - shapes.rest[v]), 1e-4);
    }
    EXPECT_NEAR(shapes.samples[1].volumeRatio, 1.0, 1e-6);
}

TEST(ElasticCylinder, IsTheSameFromRunToRunInAnySizeAndPlace) {
    const ElasticTube tube, other(0.01, {5, -3, 2});
    const ElasticShapes a = solveElasticJoint(tube.skin(), tube.joint({25, -25}));
    const ElasticShapes b = solveElasticJoint(tube.skin(), tube.joint({25, -25}));
    const ElasticShapes c = solveElasticJoint(other.skin(), other.joint({25, -25}));
    ASSERT_EQ(a.vertices, c.vertices);
    for (std::size_t s = 0; s < 2; ++s) {
        EXPECT_EQ(a.samples[s].positions, b.samples[s].positions);
        for (std::size_t v = 0; v < a.vertices.size(); ++v) {
            const glm::dvec3 back = (c.samples[s].positions[v] - glm::dvec3(5, -3, 2)) / 0.01;
            EXPECT_LT(glm::length(back - a.samples[s].positions[v]), 0.02);
        }
    }
}

TEST(ElasticSkin, MayBeOpenAtItsEnds) {
    const ElasticTube open(1.0, glm::dvec3(0.0), false), closed;
    const ElasticShapes a = solveElasticJoint(open.skin(), open.joint({45}));
    const ElasticShapes b = solveElasticJoint(closed.skin(), closed.joint({45}));
    ASSERT_EQ(a.reason, "");
    ASSERT_EQ(a.vertices, b.vertices); // the caps are out of reach
    for (std::size_t v = 0; v < a.vertices.size(); ++v)
        EXPECT_LT(glm::length(a.samples[0].positions[v] - b.samples[0].positions[v]), 0.02);
}

TEST(ElasticSkin, MayWindInwards) {
    ElasticTube inwards;
    for (auto& triangle : inwards.triangles) std::swap(triangle[0], triangle[1]);
    const ElasticShapes shapes = solveElasticJoint(inwards.skin(), inwards.joint({60, 120}));
    ASSERT_EQ(shapes.reason, "");
    EXPECT_EQ(shapes.samples[1].crossings, 0u);
}

// A sleeve around the tube, which has no interior of its own, moves with the flesh below it.
TEST(ElasticSkin, CarriesEveryShell) {
    ElasticTube dressed;
    const std::size_t skinOnly = dressed.positions.size();
    const ElasticTube sleeve(1.05, glm::dvec3(0.0), false);
    dressed.positions.insert(dressed.positions.end(), sleeve.positions.begin(),
                             sleeve.positions.end());
    for (auto triangle : sleeve.triangles) {
        for (std::uint32_t& corner : triangle) corner += static_cast<std::uint32_t>(skinOnly);
        dressed.triangles.push_back(triangle);
    }
    const ElasticShapes shapes = solveElasticJoint(dressed.skin(), dressed.joint({60}));
    ASSERT_EQ(shapes.reason, "");
    std::size_t carried = 0;
    for (std::size_t i = 0; i < shapes.vertices.size(); ++i) {
        if (shapes.vertices[i] < skinOnly) continue;
        ++carried;
        double nearest = 1e9; // to the tube's own vertices, which are 0.3 apart
        for (std::size_t k = 0; k < shapes.vertices.size(); ++k)
            if (shapes.vertices[k] < skinOnly)
                nearest = std::min(nearest, glm::length(shapes.samples[0].positions[i] -
                                                        shapes.samples[0].positions[k]));
        EXPECT_LT(nearest, 0.35);
    }
    EXPECT_GT(carried, 300u);
}

// Two tubes a tenth of a radius apart do not merge: the one that is not bent stays.
TEST(ElasticSkin, LeavesAloneWhatOnlyLiesBeside) {
    ElasticTube two;
    const std::size_t one = two.positions.size();
    const ElasticTube other(1.0, glm::dvec3(2.1, 0, 0));
    two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
    for (auto triangle : other.triangles) {
        for (std::uint32_t& corner : triangle) corner += static_cast<std::uint32_t>(one);
        two.triangles.push_back(triangle);
    }
    ElasticJoint joint = two.joint({60});
    std::fill(joint.ratios.begin() + static_cast<std::ptrdiff_t>(one), joint.ratios.end(), 0.0);
    const ElasticShapes shapes = solveElasticJoint(two.skin(), joint);
    ASSERT_EQ(shapes.reason, "");
    EXPECT_GT(shapes.vertices.size(), 300u);
    EXPECT_LT(shapes.vertices.back(), one) << "the other tube hangs on";
}

TEST(ElasticSkin, SaysWhyAJointIsNotSolved) {
    const ElasticTube tube;
    struct Case {
        const char* name;
        ElasticJoint joint;
        const char* reason;
    };
    std::vector<Case> cases(4, {"", tube.joint({45, 60}), ""});
    cases[0].name = "no radius";
    cases[0].joint.radius = 0.0;
    cases[0].reason = "its limb has no radius";
    cases[1].name = "elsewhere";
    cases[1].joint.centre = glm::dvec3(50, 0, 0);
    cases[1].reason = "there is no skin around the joint";
    cases[2].name = "wide";
    cases[2].joint.radius = 5.0;
    cases[2].reason = "its limbs end within reach";
    cases[3].name = "ratios of another skin";
    cases[3].joint.ratios.pop_back();
    cases[3].reason = "it needs one ratio for each vertex";
    for (const Case& each : cases) {
        double share = 0.0;
        const ElasticShapes shapes = solveElasticJoint(
            tube.skin(), each.joint, [&share](const ProgressStep& step) { share = step.fraction; });
        EXPECT_EQ(shapes.reason, each.reason) << each.name;
        EXPECT_TRUE(shapes.samples.empty()) << each.name;
        EXPECT_DOUBLE_EQ(share, 1.0) << each.name;
    }
}

TEST(ElasticSkin, WithoutTrianglesIsNotSolved) {
    const ElasticTube tube;
    const std::vector<std::array<std::uint32_t, 3>> none;
    EXPECT_EQ(solveElasticJoint({tube.positions, none}, tube.joint({30})).reason,
              "the skin has no triangles");
}

TEST(ElasticSkin, TellsHowFarItIsAndGivesUpWhenTold) {
    const ElasticTube tube;
    const std::vector<ElasticJoint> joints(2, tube.joint({10, -10, 20}));
    const std::thread::id caller = std::this_thread::get_id();
    std::vector<double> fractions;
    solveElasticJoints(tube.skin(), joints, [&](const ProgressStep& step) {
        EXPECT_EQ(step.what, "tube");
        EXPECT_EQ(std::this_thread::get_id(), caller);
        fractions.push_back(step.fraction);
    });
    ASSERT_FALSE(fractions.empty());
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GT(fractions.front(), 0.0);
    EXPECT_DOUBLE_EQ(fractions.back(), 1.0);

    int calls = 0;
    EXPECT_THROW(solveElasticJoints(tube.skin(), joints,
                                    [&calls](const ProgressStep&) {
                                        ++calls;
                                        throw std::runtime_error("enough");
                                    }),
                 std::runtime_error);
    EXPECT_EQ(calls, 1);
}

namespace {

/// Merges corners at the same position.
std::vector<std::array<std::uint32_t, 3>> weldedTriangles(const SkinMesh& mesh) {
    std::map<std::array<double, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> first;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        first.push_back(known.try_emplace({p.x, p.y, p.z}, v).first->second);
    }
    const std::vector<std::uint32_t> corners = mesh.triangles();
    std::vector<std::array<std::uint32_t, 3>> result;
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3)
        result.push_back({first[corners[t]], first[corners[t + 1]], first[corners[t + 2]]});
    return result;
}

} // namespace

TEST(RealElastic, ElbowFoldsWithoutCrossings) {
    const auto body = shared::makehuman() / "body/body4k_neutral.obj";
    if (!std::filesystem::exists(body)) GTEST_SKIP() << body << " is not here";
    const SkinMesh mesh = shared::readObj(body);
    const RestSkeleton rig =
        shared::readJoints(shared::makehuman() / "rig/joints_cmu_mb_neutral.json");
    const Binding binding = bind(mesh, rig);
    const auto elbow = static_cast<std::size_t>(rig.find("LeftForeArm"));
    const glm::dvec3 centre = rig.joints[elbow].centre, pole = binding.joints[elbow].boneAxis;
    const glm::dvec3 shoulder =
        rig.joints[static_cast<std::size_t>(rig.joints[elbow].parent)].centre;
    const glm::dvec3 hand = rig.joints[static_cast<std::size_t>(rig.find("LeftHand"))].centre;

    ElasticJoint joint;
    joint.name = "LeftForeArm";
    joint.centre = centre;
    joint.radius = 0.386; // where the bend is halfway
    joint.hinge = true;
    joint.bones = {{shoulder, centre, false}, {centre, hand, true}};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        double ratio = 0.0;
        for (std::size_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
            if (binding.influences[i].joint == elbow) ratio = double(binding.influences[i].bend);
        joint.ratios.push_back(ratio);
    }
    const glm::dvec3 above = glm::normalize(centre - shoulder);
    const glm::dvec3 axis = glm::normalize(glm::cross(above, pole));
    const double rest = std::acos(glm::dot(above, pole));
    for (const double total : {129.0, 139.0})
        joint.samples.push_back(glm::angleAxis(glm::radians(total) - rest, axis));

    const auto triangles = weldedTriangles(mesh);
    const ElasticShapes shapes = solveElasticJoint({mesh.positions, triangles}, joint);
    ASSERT_EQ(shapes.reason, "");
    const ElasticSkin skin{mesh.positions, triangles};
    EXPECT_GT(plainCrossings(skin, joint, joint.samples.back()), 20u);
    for (const ElasticSample& sample : shapes.samples) {
        EXPECT_EQ(sample.reason, "");
        EXPECT_LE(10 * sample.crossings, plainCrossings(skin, joint, sample.rotation));
        EXPECT_GT(sample.leastJacobian, 0.0);
        EXPECT_GT(sample.volumeRatio, 0.95);
    }

    // Vertices out of the elbow's reach, and the hand's, move with their bones.
    for (std::size_t i = 0; i < shapes.vertices.size(); ++i) {
        if (glm::length(shapes.rest[i] - centre) < 0.97 * shapes.reach) continue;
        const glm::dvec3 turned =
            centre + glm::mat3_cast(shapes.samples[0].rotation) * (shapes.rest[i] - centre);
        const glm::dvec3 expected =
            joint.ratios[shapes.vertices[i]] > 0.5 ? turned : shapes.rest[i];
        EXPECT_LT(glm::length(shapes.samples[0].positions[i] - expected), 0.02 * joint.radius);
    }
}
