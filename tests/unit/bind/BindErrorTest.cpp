// SPDX-License-Identifier: GPL-3.0-or-later
#include "Shapes.h"

#include <osgSkin/Error>
#include <osgSkinBind/Bind>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <string>

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

TEST(BindInput, AcceptsValidInput) {
    const Input input;
    EXPECT_NO_THROW(bind(input.mesh, input.skeleton, input.options).validate());
}

TEST_P(BindError, NamesTheCauseInOneLine) {
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
