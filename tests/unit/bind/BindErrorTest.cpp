// SPDX-License-Identifier: GPL-3.0-or-later
//
// A bound and posed body is the same after moving, rotating, mirroring or scaling it, and for any
// order of its joints.
//
// An application can receive progress of binding, and may cancel it.
#include "KnownBody.h"
#include "Ratios.h"
#include "Shapes.h"

#include <osgSkin/Error>
#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>
#include <osgSkinBind/Progress>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

struct Input {
    SkinMesh mesh = shapes::cylinder();
    RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    BindOptions options;
};

struct BadInput {
    const char* name;
    std::function<void(Input&)> spoil;
    const char* message;
};

void PrintTo(const BadInput& bad, std::ostream* out) {
    *out << bad.name;
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const BadInput kCases[] = {
    {"NoVertex", [](Input& i) { i.mesh = {}; }, "no vertex"},
    {"NoFace", [](Input& i) { i.mesh.faceSizes.clear(), i.mesh.faceVertices.clear(); }, "no face"},
    {"VertexNotFinite", [](Input& i) { i.mesh.positions[7].y = kNaN; }, "vertex 7"},
    {"CornerOutOfRange", [](Input& i) { i.mesh.faceVertices[0] = 99999; }, "99999"},
    {"FaceOfTwo", [](Input& i) { i.mesh.faceSizes[0] = 2; }, "2 corners"},
    {"NoJoint", [](Input& i) { i.skeleton.joints.clear(); }, "no joint"},
    {"Cycle", [](Input& i) { i.skeleton.joints[1].parent = 1; }, "no cycle"},
    {"TwoRoots", [](Input& i) { i.skeleton.joints[1].parent = -1; }, "one root"},
    {"CentreNotFinite", [](Input& i) { i.skeleton.joints[1].centre.x = kInfinity; }, "not finite"},
    {"UnknownJoint", [](Input& i) { i.options.joints["Elbow"].skip = true; }, "\"Elbow\""},
    {"UnknownRigid", [](Input& i) { i.options.rigid = {"Tail"}; }, "\"Tail\""},
    {"NoSmoothing", [](Input& i) { i.options.smoothing = 0.0; }, "above 0"},
    {"NegativeSmoothing", [](Input& i) { i.options.smoothing = -1.0; }, "above 0"},
    {"SmoothingNotFinite", [](Input& i) { i.options.smoothing = kInfinity; }, "finite"},
    {"SmoothingNaN", [](Input& i) { i.options.smoothing = kNaN; }, "finite"},
    {"CutOffOfHalf", [](Input& i) { i.options.cutOff = 0.5; }, "0 <= cutOff < 0.5"},
    {"NegativeCutOff", [](Input& i) { i.options.cutOff = -0.01; }, "0 <= cutOff < 0.5"},
    {"CutOffNaN", [](Input& i) { i.options.cutOff = kNaN; }, "0 <= cutOff < 0.5"},
    {"NoPartialJoint", [](Input& i) { i.options.maxPartialInfluences = 0; }, "expected 1 to 8"},
    {"TooManyPartialJoints", [](Input& i) { i.options.maxPartialInfluences = 9; },
     "expected 1 to 8"},
    {"TooManyInfluences", [](Input& i) { i.options.maxInfluences = i.mesh.positions.size(); },
     "(option maxInfluences)"},
    {"BoundariesSwapped",
     [](Input& i) {
         i.options.joints["joint1"].bendUpper = 0.5;
         i.options.joints["joint1"].bendLower = -0.5;
     },
     "bend boundaries of joint \"joint1\" are out of order"},
    {"BoundaryNotFinite", [](Input& i) { i.options.joints["joint1"].twistUpper = kNaN; },
     "twist boundaries of joint \"joint1\" are not finite"},
};

class BindError : public testing::TestWithParam<BadInput> {};

} // namespace

TEST(BindInput, UnspoiltIsAccepted) {
    const Input input;
    EXPECT_NO_THROW(bind(input.mesh, input.skeleton, input.options).validate());
}

TEST_P(BindError, IsOneLineThatSaysWhatWasExpected) {
    Input input;
    GetParam().spoil(input);
    try {
        bind(input.mesh, input.skeleton, input.options);
        FAIL() << "nothing was thrown, expected an error with: " << GetParam().message;
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(GetParam().message), std::string::npos) << what;
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
}

INSTANTIATE_TEST_SUITE_P(All, BindError, testing::ValuesIn(kCases),
                         [](const auto& named) { return std::string(named.param.name); });

namespace {

using Turns = std::map<std::string, glm::dquat>;

const Turns kTurns = {{"Hips", glm::angleAxis(0.4, glm::normalize(glm::dvec3(1, 2, 0)))},
                      {"Spine1", glm::angleAxis(0.3, glm::dvec3(0, 1, 0))},
                      {"LeftArm", glm::angleAxis(0.9, glm::normalize(glm::dvec3(0, 1, 2)))},
                      {"LeftForeArm", glm::angleAxis(1.6, glm::normalize(glm::dvec3(1, 1, 0)))},
                      {"LeftHand", glm::angleAxis(1.2, glm::dvec3(1, 0, 0))},
                      {"RightUpLeg", glm::angleAxis(-1.1, glm::dvec3(1, 0, 0))},
                      {"RightLeg", glm::angleAxis(1.4, glm::dvec3(1, 0, 0))}};

double heightOf(const KnownBody& body) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const glm::dvec3& p : body.mesh.positions) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    return high - low;
}

/// A map of space: x -> offset + scale * axes x, with orthogonal axes, possibly mirrored.
struct Similarity {
    const char* name;
    glm::dmat3 axes;
    double scale;
    glm::dvec3 offset;
    double tolerance; ///< in heights of the body

    glm::dvec3 operator()(const glm::dvec3& p) const { return offset + scale * (axes * p); }
    glm::dquat operator()(const glm::dquat& q) const {
        // A mirror reverses the rotation about the mirrored axis.
        const glm::dvec3 axis = glm::determinant(axes) * (axes * glm::dvec3(q.x, q.y, q.z));
        return {q.w, axis};
    }
};

double worstDistance(const KnownBody& a, const KnownBody& b) {
    double worst = 0.0;
    for (std::size_t v = 0; v < a.mesh.positions.size(); ++v)
        worst = std::max(worst, glm::distance(a.mesh.positions[v], b.mesh.positions[v]));
    return worst;
}

/// The same skeleton with each joint's children in reverse order.
osgSkin::RestSkeleton reordered(const osgSkin::RestSkeleton& skeleton) {
    std::vector<std::size_t> order, open{0};
    while (!open.empty()) {
        const std::size_t joint = open.back();
        open.pop_back();
        order.push_back(joint);
        for (std::size_t child = 0; child < skeleton.joints.size(); ++child)
            if (skeleton.joints[child].parent == static_cast<int>(joint)) open.push_back(child);
    }
    osgSkin::RestSkeleton result;
    for (const std::size_t joint : order) {
        result.joints.push_back(skeleton.joints[joint]);
        const auto parent = std::find(order.begin(), order.end(),
                                      static_cast<std::size_t>(skeleton.joints[joint].parent));
        if (skeleton.joints[joint].parent >= 0)
            result.joints.back().parent = static_cast<int>(parent - order.begin());
    }
    return result;
}

} // namespace

TEST(BindTrust, ABodyIsTheSameEverywhere) {
    const glm::dmat3 none(1.0);
    const glm::dmat3 turned =
        glm::mat3_cast(glm::angleAxis(2.3, glm::normalize(glm::dvec3(1, -2, 0.5))));
    glm::dmat3 mirrored(1.0);
    mirrored[0][0] = -1.0;
    // Far from the origin a float's steps are 1/128.
    const Similarity cases[] = {{"turned", turned, 1.0, {}, 1e-5},
                                {"mirrored", mirrored, 1.0, {}, 1e-5},
                                {"small", none, 1e-4, {}, 1e-5},
                                {"large", none, 1e4, {}, 1e-5},
                                {"far", none, 100.0, {1e5, -1e5, 1e5}, 3e-4}};
    const KnownBody body = KnownBody::thrower();
    const KnownBody posed = body.posed(kTurns);
    EXPECT_GT(worstDistance(posed, body), 0.1 * heightOf(body));
    for (const Similarity& map : cases) {
        Turns turns;
        for (const auto& [joint, turn] : kTurns) turns[joint] = map(turn);
        const KnownBody result = body.mapped(map).posed(turns);
        const double worst =
            worstDistance(result, posed.mapped(map)) / (map.scale * heightOf(body));
        EXPECT_LT(worst, map.tolerance) << map.name;
        RecordProperty(map.name, std::to_string(worst));
    }
}

TEST(BindTrust, TheOrderOfJointsDoesNotMatter) {
    const KnownBody body = KnownBody::thrower();
    KnownBody other = body;
    other.truth = reordered(body.truth);
    ASSERT_EQ(other.truth.joints.size(), body.truth.joints.size());
    ASSERT_NE(other.truth.joints[1].name, body.truth.joints[1].name);
    EXPECT_LT(worstDistance(body.posed(kTurns), other.posed(kTurns)), 1e-5 * heightOf(body));
    // Rotations of both legs, which the skin between them follows in part, do not commute.
    Turns split = kTurns;
    split["LeftUpLeg"] = glm::angleAxis(1.0, glm::normalize(glm::dvec3(-1, 0, 1)));
    split["LowerBack"] = glm::angleAxis(0.5, glm::normalize(glm::dvec3(1, 1, 1)));
    EXPECT_LT(worstDistance(body.posed(split), other.posed(split)), 1e-5 * heightOf(body));
}

namespace {

struct OddInput {
    const char* name;
    std::function<void(SkinMesh&, RestSkeleton&)> make; ///< from the cylinder and two joints
};

void PrintTo(const OddInput& odd, std::ostream* out) {
    *out << odd.name;
}

void addTriangle(SkinMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.faceSizes.push_back(3);
    mesh.faceVertices.insert(mesh.faceVertices.end(), {a, b, c});
}

const OddInput kDegenerateCases[] = {
    {"SingleTriangle",
     [](SkinMesh& m, RestSkeleton&) {
         m = {};
         m.positions = {{0, 0, 0}, {1, 4, 0}, {0, 8, 0}};
         addTriangle(m, 0, 1, 2);
     }},
    {"Coplanar",
     [](SkinMesh& m, RestSkeleton&) {
         for (glm::dvec3& p : m.positions) p.z = 0.0;
     }},
    {"Collinear",
     [](SkinMesh& m, RestSkeleton&) {
         for (glm::dvec3& p : m.positions) p.x = p.z = 0.0;
     }},
    {"AllInOnePoint",
     [](SkinMesh& m, RestSkeleton&) {
         for (glm::dvec3& p : m.positions) p = {1, 2, 3};
     }},
    {"AllAtTheOrigin",
     [](SkinMesh& m, RestSkeleton&) {
         for (glm::dvec3& p : m.positions) p = {0, 0, 0};
     }},
    {"SingleJoint", [](SkinMesh&, RestSkeleton& s) { s.joints.resize(1); }},
    {"JointsInOnePoint",
     [](SkinMesh&, RestSkeleton& s) {
         s.joints[1].centre = s.joints[0].centre;
         s.joints[1].tip.reset();
     }},
    {"JointOnAVertex", [](SkinMesh& m, RestSkeleton& s) { s.joints[1].centre = m.positions[260]; }},
    {"AllJointsOutside",
     [](SkinMesh&, RestSkeleton& s) {
         for (RestJoint& joint : s.joints) joint.centre.z += 50.0;
     }},
    {"BoneFoldedBack", [](SkinMesh&, RestSkeleton& s) { s.joints[1].tip = s.joints[0].centre; }},
    {"UnusedVertices",
     [](SkinMesh& m, RestSkeleton&) {
         m.positions.emplace_back(0, 7.5, 1.5);
         m.positions.emplace_back(0, 0.2, 1.5);
     }},
    {"DuplicatedFaces",
     [](SkinMesh& m, RestSkeleton&) {
         const SkinMesh copy = m;
         m.faceSizes.insert(m.faceSizes.end(), copy.faceSizes.begin(), copy.faceSizes.end());
         m.faceVertices.insert(m.faceVertices.end(), copy.faceVertices.begin(),
                               copy.faceVertices.end());
     }},
    {"NonManifoldEdge",
     [](SkinMesh& m, RestSkeleton&) {
         m.positions.emplace_back(3, 4, 0);
         const auto fin = static_cast<std::uint32_t>(m.positions.size() - 1);
         addTriangle(m, 256, 272, fin);
         addTriangle(m, 272, 256, fin);
     }},
    {"ZeroAreaTriangles",
     [](SkinMesh& m, RestSkeleton&) {
         addTriangle(m, 0, 16, 32); // three collinear vertices
         addTriangle(m, 5, 5, 21);
         m.positions.push_back(0.5 * (m.positions[0] + m.positions[16]));
         addTriangle(m, 0, 16, static_cast<std::uint32_t>(m.positions.size() - 1));
     }},
    {"OnlyZeroAreaTriangles",
     [](SkinMesh& m, RestSkeleton&) {
         m.faceSizes.clear(), m.faceVertices.clear();
         addTriangle(m, 0, 0, 1);
     }},
    {"InsideOut",
     [](SkinMesh& m, RestSkeleton&) {
         std::size_t first = 0;
         for (const std::uint32_t size : m.faceSizes) {
             const auto at = m.faceVertices.begin() + static_cast<std::ptrdiff_t>(first);
             std::reverse(at, at + size);
             first += size;
         }
     }},
    {"ThousandJoints",
     [](SkinMesh&, RestSkeleton& s) {
         for (int j = 2; j < 1000; ++j)
             s.joints.push_back({"j" + std::to_string(j), j - 1, {0, 4.1 + 0.003 * j, 0}, {}});
         s.joints[1].tip.reset();
     }},
    {"ThousandLeaves",
     [](SkinMesh&, RestSkeleton& s) {
         for (int j = 2; j < 1000; ++j)
             s.joints.push_back({"j" + std::to_string(j), 1, {0, 4.1, 0.001 * j}, {}});
     }},
    {"HundredJointsInOnePoint",
     [](SkinMesh&, RestSkeleton& s) {
         s.joints[1].tip.reset();
         for (int j = 2; j < 100; ++j)
             s.joints.push_back({"j" + std::to_string(j), j - 1, s.joints[1].centre, {}});
     }},
    {"TipInTheJoint", [](SkinMesh&, RestSkeleton& s) { s.joints[1].tip = s.joints[1].centre; }},
    {"OneVertexTwiceAndAgain",
     [](SkinMesh& m, RestSkeleton&) {
         m = {};
         m.positions.assign(3, {0, 4, 1});
         addTriangle(m, 0, 1, 2);
         addTriangle(m, 0, 0, 0);
     }},
    {"Huge",
     [](SkinMesh& m, RestSkeleton& s) {
         m = shapes::moved(m, {0, 0, 0}, 1e17);
         for (RestJoint& joint : s.joints) joint.centre *= 1e17;
         s.joints[1].tip = 1e17 * *s.joints[1].tip;
     }},
    {"Tiny",
     [](SkinMesh& m, RestSkeleton& s) {
         m = shapes::moved(m, {0, 0, 0}, 1e-7);
         for (RestJoint& joint : s.joints) joint.centre *= 1e-7;
         s.joints[1].tip = 1e-7 * *s.joints[1].tip;
     }},
};

std::uint32_t skeletonEnd(const RestSkeleton& skeleton) {
    return static_cast<std::uint32_t>(skeleton.joints.size() - 1);
}

class Degenerate : public testing::TestWithParam<OddInput> {};

} // namespace

TEST_P(Degenerate, IsBoundAllTheSame) {
    SkinMesh mesh = shapes::cylinder();
    RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    GetParam().make(mesh, skeleton);
    BindOptions options;
    for (const auto method : {BindOptions::Method::Smooth, BindOptions::Method::Paper}) {
        options.method = method;
        BindReport report;
        const Binding binding = bind(mesh, skeleton, options, &report);
        expectSound(binding);
        EXPECT_EQ(binding.vertexCount(), mesh.positions.size());
        EXPECT_EQ(report.unassigned, 0u);
    }
    const VertexWeights weights(mesh.positions.size(), {{0, 0.5}, {skeletonEnd(skeleton), 0.5}});
    expectSound(bindWeights(mesh, skeleton, weights, options));
}

INSTANTIATE_TEST_SUITE_P(All, Degenerate, testing::ValuesIn(kDegenerateCases),
                         [](const auto& named) { return std::string(named.param.name); });

TEST(UnusedVertex, DoesAsTheNearestSkin) {
    SkinMesh mesh = shapes::cylinder();
    mesh.positions.emplace_back(0, 7.5, 1.5);
    const std::size_t unused = mesh.positions.size() - 1;
    const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.0));
    EXPECT_EQ(binding.regions[unused], 1u);
    EXPECT_EQ(ratiosOf(binding, unused, 1).bend, 1.0f);
}

TEST(InsideOutSkin, BindsLikeTheOther) {
    SkinMesh mesh = shapes::hangingArms();
    const Binding outside = bind(mesh, shapes::hangingArmsSkeleton());
    for (std::size_t f = 0; f < mesh.faceSizes.size(); ++f)
        std::swap(mesh.faceVertices[4 * f + 1], mesh.faceVertices[4 * f + 3]);
    BindReport report;
    const Binding inside = bind(mesh, shapes::hangingArmsSkeleton(), {}, &report);
    EXPECT_EQ(inside.regions, outside.regions);
    EXPECT_TRUE(report.notes.empty()) << report.text();
}

namespace {

struct Recorder {
    std::vector<std::string> whats;
    std::vector<double> fractions;
    Progress progress() {
        return [this](const ProgressStep& step) {
            whats.push_back(step.what);
            fractions.push_back(step.fraction);
        };
    }
};

} // namespace

TEST(Progress, APartIsMappedIntoTheWhole) {
    Recorder recorder;
    const Progress part = subProgress(recorder.progress(), 0.25, 0.75, "binding");
    part({"welding", 0.0});
    part({"bends", 0.5});
    subProgress(part, 0.5, 1.0)({"last bend", 0.5});
    part({"done", 1.0});
    EXPECT_EQ(recorder.whats, (std::vector<std::string>{"binding: welding", "binding: bends",
                                                        "binding: last bend", "binding: done"}));
    EXPECT_EQ(recorder.fractions, (std::vector<double>{0.25, 0.5, 0.625, 0.75}));
}

TEST(Progress, APartOfNothingIsNothing) {
    EXPECT_FALSE(subProgress({}, 0.0, 1.0));
}

TEST(Progress, BindingRisesFromZeroToOne) {
    for (const BindOptions::Method method :
         {BindOptions::Method::Smooth, BindOptions::Method::Paper}) {
        Recorder recorder;
        BindOptions options;
        options.method = method;
        options.progress = recorder.progress();
        bind(shapes::cylinder(), shapes::chainAlongY({1.1, 4.1}, 7.0), options);
        ASSERT_GE(recorder.fractions.size(), 6u);
        EXPECT_EQ(recorder.fractions.front(), 0.0);
        EXPECT_EQ(recorder.fractions.back(), 1.0);
        EXPECT_TRUE(std::is_sorted(recorder.fractions.begin(), recorder.fractions.end()));
    }
}

TEST(Progress, WhatItThrowsCancelsTheBinding) {
    BindOptions options;
    options.progress = [](const ProgressStep& step) {
        if (step.what == "flooding") throw std::runtime_error("cancelled");
    };
    EXPECT_THROW(bind(shapes::cylinder(), shapes::chainAlongY({1.1, 4.1}, 7.0), options),
                 std::runtime_error);
}
