// SPDX-License-Identifier: GPL-3.0-or-later
//
// Degenerate meshes and skeletons are bound like any other.
#include "Ratios.h"
#include "Shapes.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>
#include <string>

using namespace osgSkin;

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

class DegenerateInput : public testing::TestWithParam<OddInput> {};

} // namespace

TEST_P(DegenerateInput, BindsEveryVertex) {
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

INSTANTIATE_TEST_SUITE_P(All, DegenerateInput, testing::ValuesIn(kDegenerateCases),
                         [](const auto& named) { return std::string(named.param.name); });

TEST(UnusedVertex, FollowsTheNearestSkin) {
    SkinMesh mesh = shapes::cylinder();
    mesh.positions.emplace_back(0, 7.5, 1.5);
    const std::size_t unused = mesh.positions.size() - 1;
    const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.0));
    EXPECT_EQ(binding.regions[unused], 1u);
    EXPECT_EQ(ratiosOf(binding, unused, 1).bend, 1.0f);
}

TEST(InsideOutSkin, BindsLikeTheOriginal) {
    SkinMesh mesh = shapes::hangingArms();
    const Binding outside = bind(mesh, shapes::hangingArmsSkeleton());
    for (std::size_t f = 0; f < mesh.faceSizes.size(); ++f)
        std::swap(mesh.faceVertices[4 * f + 1], mesh.faceVertices[4 * f + 3]);
    BindReport report;
    const Binding inside = bind(mesh, shapes::hangingArmsSkeleton(), {}, &report);
    EXPECT_EQ(inside.regions, outside.regions);
    EXPECT_TRUE(report.notes.empty()) << report.text();
}
