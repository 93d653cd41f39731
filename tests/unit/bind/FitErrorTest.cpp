// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bodies and landmarks that no skeleton fits: refused with one line.
#include "KnownBody.h"
#include "Shapes.h"

#include <osgSkin/Error>
#include <osgSkinBind/FitSkeleton>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

using namespace osgSkin;

namespace {

/// The faces whose corners `keep` all accepts.
SkinMesh cut(const SkinMesh& mesh, const std::function<bool(const glm::dvec3&)>& keep) {
    SkinMesh result;
    result.positions = mesh.positions;
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        bool all = true;
        for (std::size_t i = corner; i < corner + size; ++i)
            all = all && keep(mesh.positions[mesh.faceVertices[i]]);
        if (all) {
            result.faceSizes.push_back(size);
            for (std::size_t i = corner; i < corner + size; ++i)
                result.faceVertices.push_back(mesh.faceVertices[i]);
        }
        corner += size;
    }
    return result;
}

struct BadBody {
    const char* name;
    SkinMesh (*make)(const SkinMesh& thrower);
    const char* expected; ///< part of the message
};

void PrintTo(const BadBody& bad, std::ostream* out) {
    *out << bad.name;
}

/// A person of boxes: trunk and head, legs, and arms at the given heights.
SkinMesh boxPerson(const std::vector<int>& arms) {
    const auto filled = [&](int x, int y, int z) {
        if (z < -1 || z > 0) return false;
        const int aside = x < 0 ? -x - 1 : x;
        if (y < 0) return y >= -10 && aside >= 1 && aside < 3;
        if (y < 8) {
            if (aside < 3) return true;
            for (const int arm : arms)
                if ((y == arm || y == arm + 1) && aside < 11) return true;
            return false;
        }
        return y < 12 && aside < 1;
    };
    return shapes::voxelSurface(filled, 14, 0.1);
}

const BadBody kBadBodies[] = {
    {"empty", [](const SkinMesh&) { return SkinMesh{}; }, "vert"},
    {"not_finite",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         bad.positions[7].y = std::numeric_limits<double>::quiet_NaN();
         return bad;
     },
     "finite"},
    {"of_no_area",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         for (glm::dvec3& p : bad.positions) p = glm::dvec3(1.0, 2.0, 3.0);
         return bad;
     },
     "area"},
    {"flat",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         for (glm::dvec3& p : bad.positions) p.z = 0.0;
         return bad;
     },
     "flat"},
    {"cylinder", [](const SkinMesh&) { return shapes::cylinder(); }, "expected two legs"},
    {"lying_on_its_back",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         for (glm::dvec3& p : bad.positions) p = glm::dvec3(p.x, -p.z, p.y);
         return bad;
     },
     "expected an upright body"},
    {"upside_down",
     [](const SkinMesh& m) {
         SkinMesh bad = m;
         for (glm::dvec3& p : bad.positions) p = glm::dvec3(-p.x, -p.y, p.z);
         return bad;
     },
     "expected two legs"},
    {"without_legs",
     [](const SkinMesh& m) { return cut(m, [](const glm::dvec3& p) { return p.y > 0.95; }); },
     "expected"},
    {"with_one_leg",
     [](const SkinMesh& m) {
         return cut(m, [](const glm::dvec3& p) { return p.y > 0.75 || p.x < 0.0; });
     },
     "expected two legs"},
    {"with_one_arm",
     [](const SkinMesh& m) { return cut(m, [](const glm::dvec3& p) { return p.x < 0.24; }); },
     "expected two arms that stand off the trunk (a T or an A pose), found 1"},
    {"without_arms",
     [](const SkinMesh& m) {
         return cut(m, [](const glm::dvec3& p) { return std::abs(p.x) < 0.24; });
     },
     "expected two arms that stand off the trunk (a T or an A pose), found 0"},
    {"with_four_arms",
     [](const SkinMesh&) {
         return boxPerson({2, 6});
     },
     "expected two arms"},
};

class FitError : public testing::TestWithParam<BadBody> {};

/// The error of fitSkeleton() with these options on the thrower; empty if there is none.
std::string complaint(const SkinMesh& mesh, const FitOptions& options) {
    try {
        fitSkeleton(mesh, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST_P(FitError, NamesTheCauseInOneLine) {
    const std::string said = complaint(GetParam().make(KnownBody::thrower().mesh), {});
    EXPECT_NE(said.find(GetParam().expected), std::string::npos) << '"' << said << '"';
    EXPECT_EQ(said.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Body, FitError, testing::ValuesIn(kBadBodies),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(FitOptionsError, NamesTheLandmark) {
    const SkinMesh mesh = KnownBody::thrower().mesh;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    FitOptions options;
    options.landmarks["Nose"] = {0, 1.7, 0.1};
    EXPECT_NE(complaint(mesh, options).find("landmark Nose is not a CMU joint"), std::string::npos);
    options.landmarks = {{"Head", {0.0, nan, 0.0}}};
    EXPECT_NE(complaint(mesh, options).find("landmark Head: expected finite"), std::string::npos);
    options.landmarks = {{"Head", {0.0, 2.5, 0.0}}};
    EXPECT_NE(complaint(mesh, options).find("landmark Head: expected a point inside the skin"),
              std::string::npos)
        << complaint(mesh, options);
    options.landmarks = {{"LeftLeg", {0.11, 1.2, 0.0}}}; // a knee above the hips
    EXPECT_NE(complaint(mesh, options).find("landmarks for LeftLeg and LeftFoot"),
              std::string::npos)
        << complaint(mesh, options);
}

TEST(FitOptionsError, RejectsBadDirections) {
    const SkinMesh mesh = KnownBody::thrower().mesh;
    FitOptions options;
    options.up = glm::dvec3(0.0);
    EXPECT_NE(complaint(mesh, options).find("expected an up axis"), std::string::npos);
    options = {};
    options.facing = glm::dvec3(0.0);
    EXPECT_NE(complaint(mesh, options).find("expected a facing"), std::string::npos);
    options.facing = glm::dvec3(1.0, 0.0, 0.0); // the side of its left hand
    EXPECT_NE(complaint(mesh, options).find("must be perpendicular"), std::string::npos);
    options.facing = glm::dvec3(0.0, 0.0, -1.0);
    options.landmarks["LeftHand"] = {0.62, 1.07, 0.0115};
    EXPECT_NE(complaint(mesh, options).find("disagree"), std::string::npos);
}
