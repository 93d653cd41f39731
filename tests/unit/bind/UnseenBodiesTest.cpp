// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bodies of other proportions than the available ones, derived from them.
//
// Fields for a joint's typical rotations: on a sheet, and on bodies.
//
// Detecting stretched parts of a skin, on a ring: closed, cut, and alone.
//
// Real bodies, bound with default settings.
#include "KnownBody.h"
#include "Patches.h"
#include "Ratios.h"
#include "Shapes.h"
#include "SharedBody.h"
#include "Stretches.h"
#include "mesh/HeatGraph.h"
#include "mesh/SkinSmoother.h"
#include "mesh/WeldedMesh.h"
#include "ratios/MinimizeStretch.h"
#include "ratios/RatioFields.h"
#include "regions/Regions.h"

#include <osgSkin/Deform>
#include <osgSkinBind/Bind>
#include <osgSkinBind/RigidJoints>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

/// Moves the skin in along its normals.
KnownBody thinned(KnownBody body, double distance) {
    const WeldedMesh skin(body.mesh);
    for (std::size_t v = 0; v < body.mesh.positions.size(); ++v)
        body.mesh.positions[v] -= distance * skin.normals[skin.weldedOf[v]];
    return body;
}

/// Both forearms `factor` times as long; everything beyond an elbow moves along.
KnownBody withForearms(const KnownBody& body, double factor) {
    KnownBody result = body;
    for (const std::string side : {"Left", "Right"}) {
        const auto centre = [&](const char* joint) {
            const int found = body.truth.find(side + joint);
            return body.truth.joints[static_cast<std::size_t>(found)].centre;
        };
        const glm::dvec3 elbow = centre("ForeArm");
        const glm::dvec3 bone = centre("Hand") - elbow;
        const auto moved = [&](const glm::dvec3& p) {
            if ((p.x > 0.0) != (elbow.x > 0.0) || std::abs(p.x) < std::abs(elbow.x) - 0.5) return p;
            const double along = glm::dot(p - elbow, bone) / glm::dot(bone, bone);
            return p + (factor - 1.0) * std::clamp(along, 0.0, 1.0) * bone;
        };
        result = result.mapped(moved);
    }
    return result;
}

/// l'/l of the body's edges with both arms raised.
std::vector<double> stretchesWithArmsUp(const KnownBody& body) {
    const glm::dvec3 z(0, 0, 1);
    const KnownBody up = body.posed({{"LeftArm", glm::angleAxis(glm::radians(100.0), z)},
                                     {"RightArm", glm::angleAxis(glm::radians(-100.0), z)}});
    return stretches(body.mesh, up.mesh);
}

/// Mean ratio of the left upper arm over its middle third.
double upperArmRigidity(const KnownBody& body) {
    const Binding binding = bind(body.mesh, body.truth);
    const std::size_t arm = jointCalled(binding, "LeftArm");
    const glm::dvec3 from = binding.joints[arm].centre;
    const glm::dvec3 way = binding.joints[jointCalled(binding, "LeftForeArm")].centre - from;
    double sum = 0.0, count = 0.0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        if (binding.regions[v] != arm) continue;
        const double along = glm::dot(body.mesh.positions[v] - from, way) / glm::dot(way, way);
        if (along < 1.0 / 3.0 || along > 2.0 / 3.0) continue;
        sum += static_cast<double>(ratiosOf(binding, v, arm).bend);
        count += 1.0;
    }
    return sum / count;
}

/// A square of triangles, two units wide, with a field that rises across it from the left.
struct Sheet {
    SkinMesh mesh;
    std::vector<double> field;

    template <typename Rise>
    explicit Sheet(const Rise& rise) {
        constexpr std::uint32_t kSide = 21;
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x) {
                mesh.positions.emplace_back(0.1 * x - 1.0, 0.1 * y - 1.0, 0.0);
                field.push_back(rise(mesh.positions.back()));
                if (x == 0 || y == 0) continue;
                const std::uint32_t v = y * kSide + x;
                for (const std::uint32_t corner :
                     {v - kSide - 1, v - kSide, v, v - kSide - 1, v, v - 1})
                    mesh.faceVertices.push_back(corner);
            }
        mesh.faceSizes.assign(mesh.faceVertices.size() / 3, 3);
    }

    double shareAt(double x, double y) const {
        const auto v = static_cast<std::size_t>(std::lround(10.0 * (y + 1.0)) * 21 +
                                                std::lround(10.0 * (x + 1.0)));
        return gradientFactor(WeldedMesh(mesh), field)[v];
    }
};

} // namespace

TEST(UnseenBodies, ThinArmpitsStretchLittle) {
    const KnownBody neutral = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (neutral.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    for (const double millimetres : {0.0, 6.0, 8.0})
        EXPECT_LT(stretchesWithArmsUp(thinned(neutral, 0.01 * millimetres)).back(), 2.45)
            << millimetres << " mm thinner";
}

TEST(UnseenBodies, ThrowersArmpitsStretchLittle) {
    const std::vector<double> sorted = stretchesWithArmsUp(KnownBody::thrower());
    EXPECT_LT(sorted.back(), 2.15);
    EXPECT_LT(percentile999(sorted), 1.93);
}

TEST(UnseenBodies, LongForearmsLeaveUpperArmsRigid) {
    for (const double factor : {1.0, 1.3, 1.6})
        EXPECT_GT(upperArmRigidity(withForearms(KnownBody::thrower(), factor)), 0.965) << factor;
}

TEST(GradientFactor, IsOneWhereASlopeIsEven) {
    const Sheet even([](const glm::dvec3& p) { return 0.5 + 0.4 * p.x; });
    EXPECT_NEAR(even.shareAt(0.0, 0.0), 1.0, 1e-9);
    const Sheet flat([](const glm::dvec3&) { return 1.0; });
    EXPECT_EQ(flat.shareAt(0.0, 0.0), 1.0);
}

TEST(GradientFactor, SaysHowMuchSteeperASlopeIsThanAtLarge) {
    // Rises within two units at the lower edge, within one at the upper: on average one and a half
    // times as steep as at the lower edge. So the upper edge is a third steeper than the mean, and
    // at the lower one the share is not below 1.
    const Sheet fan([](const glm::dvec3& p) {
        const double width = 1.5 - 0.5 * p.y;
        return std::clamp(0.5 + p.x / width, 0.0, 1.0);
    });
    EXPECT_GT(fan.shareAt(0.0, 0.8), 1.2);
    EXPECT_LT(fan.shareAt(0.0, 0.8), 1.5);
    EXPECT_EQ(fan.shareAt(0.0, -0.8), 1.0);
    EXPECT_EQ(fan.shareAt(-0.9, 0.9), 1.0); // flat there
}

TEST(FacesLimb, IsTrueForATorsosSideBesideAHangingArm) {
    PlannedJoint arm;
    arm.centre = {2.0, 0.0, 0.0};
    arm.boneAxis = {0.0, -1.0, 0.0};
    arm.boneLength = 3.0;
    const double radius = 0.5;
    const glm::dvec3 outwards(1, 0, 0), inwards(-1, 0, 0);
    EXPECT_TRUE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, outwards));
    EXPECT_TRUE(facesLimb(arm, radius, {1.0, 0.5, 0.0}, outwards)) << "above the shoulder";
    EXPECT_FALSE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, inwards)) << "a very thick arm's";
    EXPECT_FALSE(facesLimb(arm, radius, {1.5, -1.0, 0.0}, outwards)) << "in the armpit";
    EXPECT_FALSE(facesLimb(arm, radius, {2.5, -1.0, 0.0}, outwards)) << "the arm's own";
    EXPECT_FALSE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, {0, 0, 1})) << "the chest";
}

namespace {

/// A square of triangles, two units wide, about the origin in the plane z = 0.
SkinMesh sheet(std::uint32_t side) {
    SkinMesh mesh;
    const double step = 2.0 / (side - 1);
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            mesh.positions.emplace_back(step * x - 1.0, step * y - 1.0, 0.0);
            if (x == 0 || y == 0) continue;
            const std::uint32_t v = y * side + x;
            for (const std::uint32_t corner : {v - side - 1, v - side, v, v - side - 1, v, v - 1})
                mesh.faceVertices.push_back(corner);
        }
    mesh.faceSizes.assign(mesh.faceVertices.size() / 3, 3);
    return mesh;
}

/// A field that rises from left to right between -0.7 and 0.7, steepest in the middle.
struct Rise {
    WeldedMesh mesh;
    std::vector<double> field;
    std::vector<bool> isFree;

    explicit Rise(std::uint32_t side = 21) : mesh(sheet(side)) {
        for (const glm::dvec3& p : mesh.positions) {
            const double t = std::clamp(0.5 + p.x / 1.4, 0.0, 1.0);
            field.push_back(t * t * t * (10.0 + t * (6.0 * t - 15.0)));
            isFree.push_back(t > 0.0 && t < 1.0);
        }
    }

    /// Largest increase along x between neighbours near a height.
    double steepestAt(double y) const {
        const auto side = static_cast<std::size_t>(std::lround(std::sqrt(mesh.positions.size())));
        const double step = 2.0 / static_cast<double>(side - 1);
        const auto row = static_cast<std::size_t>(std::lround((y + 1.0) / step)) * side;
        double most = 0.0;
        for (std::size_t x = 1; x < side; ++x)
            most = std::max(most, (field[row + x] - field[row + x - 1]) / step);
        return most;
    }
};

/// About the sheet's centre: the lower half is stretched, the upper half compressed.
const std::vector<glm::dvec3> kTurn = {{0.0, 0.0, 1.5}};

} // namespace

TEST(MinimizeStretch, SpreadsWhereSkinIsStretched) {
    Rise rise;
    const double before = rise.steepestAt(-0.8);
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_LT(rise.steepestAt(-0.8), 0.7 * before);
    EXPECT_GT(rise.steepestAt(0.0), 1.2 * rise.steepestAt(-0.8));
    for (const double a : rise.field) {
        EXPECT_GE(a, 0.0);
        EXPECT_LE(a, 1.0);
    }
}

TEST(MinimizeStretch, KeepsWhatIsNotFree) {
    Rise rise;
    const std::vector<double> before = rise.field;
    for (std::size_t v = 0; v < before.size(); v += 3) rise.isFree[v] = false;
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_NE(rise.field, before);
    for (std::size_t v = 0; v < before.size(); ++v)
        if (!rise.isFree[v]) {
            EXPECT_EQ(rise.field[v], before[v]) << v;
        }
    rise.field = before;
    rise.isFree.assign(before.size(), false);
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_EQ(rise.field, before);
}

TEST(MinimizeStretch, IsNearlyTheSameOnACoarserCopy) {
    Rise fine(121);
    const std::vector<double> before = fine.field;
    Rise whole = fine;
    minimizeStretch(HeatGraph(whole.mesh), whole.field, whole.isFree, glm::dvec3(0.0), kTurn);
    const SkinSmoother smoother(fine.mesh, 0.7);
    std::size_t vertices = 0;
    smoother.change(fine.field, fine.isFree, 0.7,
                    [&vertices](const HeatGraph& skin, std::vector<double>& field,
                                const std::vector<bool>& isFree) {
                        vertices = field.size();
                        minimizeStretch(skin, field, isFree, glm::dvec3(0.0), kTurn);
                    });
    EXPECT_LT(vertices, fine.field.size() / 3);
    double most = 0.0, moved = 0.0;
    for (std::size_t v = 0; v < before.size(); ++v) {
        most = std::max(most, std::abs(fine.field[v] - whole.field[v]));
        moved = std::max(moved, std::abs(whole.field[v] - before[v]));
        if (!fine.isFree[v]) {
            EXPECT_EQ(fine.field[v], before[v]) << v;
        }
    }
    EXPECT_GT(moved, 0.1);
    EXPECT_LT(most, 0.5 * moved);
}

TEST(UnseenBodies, ArmsThatReachForwardsStretchLittle) {
    const KnownBody neutral = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (neutral.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    const glm::dvec3 forwards = glm::normalize(glm::dvec3(-0.8, 0.3, 0.6));
    const KnownBody posed = neutral.posed(
        {{"LeftArm", glm::angleAxis(glm::radians(80.0), forwards)},
         {"RightArm",
          glm::angleAxis(glm::radians(80.0), glm::dvec3(forwards.x, -forwards.y, -forwards.z))}});
    const std::vector<double> sorted = stretches(neutral.mesh, posed.mesh);
    EXPECT_LT(percentile999(sorted), 1.52); // 1.55 without swings
    EXPECT_LT(sorted.back(), 1.60);         // 1.67
}

/// A pad over the shoulder that is attached to nothing keeps its field.
TEST(UnseenBodies, PadsOnTheShoulderStayOnIt) {
    KnownBody body = KnownBody::shared("body4k_neutral", "cmu_mb_neutral");
    if (body.mesh.positions.empty()) GTEST_SKIP() << "needs ../shared/data/makehuman";
    const glm::dvec3 shoulder =
        body.truth.joints.at(std::size_t(body.truth.find("LeftArm"))).centre;
    const std::vector<glm::dvec3> skin = body.mesh.positions;
    const double height = glm::distance(shoulder, body.truth.joints.front().centre) * 3.0;
    // The pad vertex of each skin vertex, moved away from the joint by a hundredth of the height.
    std::vector<std::uint32_t> padOf(skin.size(), 0), below;
    const std::vector<std::uint32_t> corners = body.mesh.triangles();
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        const auto isNear = [&](std::uint32_t v) {
            return glm::distance(skin[v], shoulder) < 0.045 * height;
        };
        if (!std::all_of(corners.begin() + std::ptrdiff_t(t),
                         corners.begin() + std::ptrdiff_t(t + 3), isNear))
            continue;
        for (std::size_t c = t; c < t + 3; ++c) {
            const std::uint32_t v = corners[c];
            if (padOf[v] == 0) {
                padOf[v] = static_cast<std::uint32_t>(body.mesh.positions.size());
                below.push_back(v);
                body.mesh.positions.push_back(skin[v] +
                                              0.01 * height * glm::normalize(skin[v] - shoulder));
            }
            body.mesh.faceVertices.push_back(padOf[v]);
        }
        body.mesh.faceSizes.push_back(3);
    }
    ASSERT_GT(below.size(), 30u);
    const glm::dvec3 forwards = glm::normalize(glm::dvec3(-0.8, 0.3, 0.6));
    const KnownBody posed = body.posed({{"LeftArm", glm::angleAxis(glm::radians(80.0), forwards)}});
    double farthest = 0.0;
    for (std::size_t i = 0; i < below.size(); ++i)
        farthest = std::max(farthest, glm::distance(posed.mesh.positions[skin.size() + i],
                                                    posed.mesh.positions[below[i]]));
    EXPECT_LT(farthest, 0.02 * height); // 0.03 if it is stretched
}

namespace {

constexpr std::uint32_t kAround = 24, kThrough = 8;

/// A closed ring whose field rises from 0 on its left to 1 on its right, above and below.
struct Ring {
    SkinMesh mesh;
    std::vector<double> field;
    std::vector<bool> isFree;

    Ring() {
        for (std::uint32_t i = 0; i < kAround; ++i)
            for (std::uint32_t k = 0; k < kThrough; ++k) {
                const double a = glm::two_pi<double>() * i / kAround;
                const double b = glm::two_pi<double>() * k / kThrough;
                const double far = 3.0 + std::cos(b);
                mesh.positions.emplace_back(far * std::cos(a), far * std::sin(a), std::sin(b));
                field.push_back(std::clamp(0.5 + 0.8 * std::cos(a), 0.0, 1.0));
                isFree.push_back(field.back() > 0.0 && field.back() < 1.0);
                const auto at = [](std::uint32_t u, std::uint32_t w) {
                    return u % kAround * kThrough + w % kThrough;
                };
                for (const std::uint32_t corner : {at(i, k), at(i + 1, k), at(i + 1, k + 1),
                                                   at(i, k), at(i + 1, k + 1), at(i, k + 1)})
                    mesh.faceVertices.push_back(corner);
            }
        mesh.faceSizes.assign(mesh.faceVertices.size() / 3, 3);
    }

    /// The numbers of vertices above and below the middle that stay free.
    std::pair<std::size_t, std::size_t> freeAfter() const {
        std::vector<bool> free = isFree;
        pinUnanchoredPatches(HeatGraph(WeldedMesh(mesh)), field, free);
        std::size_t above = 0, below = 0;
        for (std::size_t v = 0; v < free.size(); ++v)
            if (free[v]) ++(mesh.positions[v].y > 0.0 ? above : below);
        return {above, below};
    }
};

} // namespace

TEST(PinnedPatches, BetweenBothKindsStaysFree) {
    const Ring ring;
    const auto all =
        static_cast<std::size_t>(std::count(ring.isFree.begin(), ring.isFree.end(), true));
    const auto [above, below] = ring.freeAfter();
    EXPECT_GT(above, 10u);
    EXPECT_EQ(above, below);
    EXPECT_EQ(above + below, all);
}

TEST(PinnedPatches, WhatEndsIsKept) {
    Ring ring;
    const auto whole = ring.freeAfter();
    // One triangle fewer, at the top.
    const std::size_t cut = std::size_t(6) * kThrough * (kAround / 4);
    ring.mesh.faceVertices.erase(ring.mesh.faceVertices.begin() + std::ptrdiff_t(cut),
                                 ring.mesh.faceVertices.begin() + std::ptrdiff_t(cut + 3));
    ring.mesh.faceSizes.pop_back();
    EXPECT_EQ(ring.freeAfter(), std::make_pair(std::size_t(0), whole.second));
}

TEST(PinnedPatches, WhatNobodyHoldsAtBothEndsIsKept) {
    const std::pair<std::size_t, std::size_t> none;
    Ring ring;
    ring.isFree.assign(ring.isFree.size(), true);
    EXPECT_EQ(ring.freeAfter(), none);
    for (const double end : {0.0, 1.0}) {
        Ring one;
        for (std::size_t v = 0; v < one.field.size(); ++v) one.isFree[v] = one.field[v] != end;
        EXPECT_EQ(one.freeAfter(), none) << end;
    }
}

namespace {

struct BodyCase {
    const char* name;
    const char* mesh; ///< below the shared data
    const char* rig;  ///< joints_*.json of MakeHuman; our own rig if it names a folder
    SkinMesh (*change)(const SkinMesh&, const RestSkeleton&);
    std::size_t shells;
    double longestReach; ///< l'/l with the arms raised; they may rest at any lower angle
};

void PrintTo(const BodyCase& body, std::ostream* out) {
    *out << body.name;
}

SkinMesh asItIs(const SkinMesh& mesh, const RestSkeleton&) {
    return mesh;
}

/// As with texture seams along every edge.
SkinMesh exploded(const SkinMesh& mesh, const RestSkeleton&) {
    return shapes::exploded(mesh);
}

/// Two eyes inside the head, and trousers around the legs.
SkinMesh dressed(const SkinMesh& body, const RestSkeleton& skeleton) {
    const SkinMesh ball = shapes::voxelSurface(
        [](int x, int y, int z) {
            return (x + .5) * (x + .5) + (y + .5) * (y + .5) + (z + .5) * (z + .5) < 9.0;
        },
        4, 0.05);
    const auto at = [&](const char* joint) {
        return skeleton.joints[static_cast<std::size_t>(skeleton.find(joint))].centre;
    };
    const glm::dvec3 head = at("Head") + glm::dvec3(0.0, 0.6, 0.6);
    SkinMesh all = shapes::joined(body, shapes::moved(ball, head + glm::dvec3(0.3, 0, 0)));
    all = shapes::joined(all, shapes::moved(ball, head - glm::dvec3(0.3, 0, 0)));
    // Trousers, excluding the hands beside them.
    const double low = at("LeftFoot").y + 1.0, high = at("LowerBack").y - 0.3;
    const auto isBelow = [&](const glm::dvec3& p) {
        return p.y > low && p.y < high && std::abs(p.x) < 2.2;
    };
    return shapes::joined(all, shapes::garment(body, isBelow, 0.08));
}

const BodyCase kBodies[] = {
    {"Quads", "makehuman/body/body_neutral.obj", "cmu_mb_neutral", asItIs, 1, 3.5},
    {"AnotherAuthors", "human_blend/human_4282.obj", "skeleton/human_4282", asItIs, 1, 5.5},
    {"SparseAndOpen", "makehuman/body/proxy_male1591_on_male_skin.obj", "cmu_mb_male", asItIs, 1,
     3.5},
    {"SplitVertices", "makehuman/body/body4k_neutral.obj", "cmu_mb_neutral", exploded, 1, 3.5},
    {"EyesAndTrousers", "makehuman/body/body4k_male.obj", "cmu_mb_male", dressed, 4, 3.5},
};

class RealBody : public testing::TestWithParam<BodyCase> {
protected:
    void SetUp() override {
        const std::filesystem::path shared = shared::makehuman().parent_path();
        const auto meshFile = shared / GetParam().mesh;
        const std::string rig = GetParam().rig;
        const auto rigFile = rig.find('/') != std::string::npos
                                 ? std::filesystem::path(OSGSKIN_TEST_DATA) / (rig + ".json")
                                 : shared::makehuman() / "rig" / ("joints_" + rig + ".json");
        if (!std::filesystem::exists(meshFile) || !std::filesystem::exists(rigFile))
            GTEST_SKIP() << "needs " << meshFile << " and " << rigFile;
        skeleton = shared::readJoints(rigFile);
        mesh = GetParam().change(shared::readObj(meshFile), skeleton);
        BindOptions options; // nothing moves fingers and toes
        options.rigid =
            automaticRigidJoints(skeleton, {}, std::vector<bool>(skeleton.joints.size()));
        binding = bind(mesh, skeleton, options, &report);
    }

    /// The skin with the given joints rotated by degrees about x or z, parents first.
    std::vector<glm::dvec3>
    posed(const std::vector<std::pair<std::string, glm::dvec2>>& turns) const {
        std::vector<glm::dmat4> skinning(skeleton.joints.size(), glm::dmat4(1.0));
        for (std::size_t j = 1; j < skinning.size(); ++j) {
            skinning[j] = skinning[static_cast<std::size_t>(skeleton.joints[j].parent)];
            for (const auto& [name, degrees] : turns) {
                if (skeleton.joints[j].name != name) continue;
                const glm::dmat4 unit(1.0);
                skinning[j] *= glm::translate(unit, skeleton.joints[j].centre) *
                               glm::rotate(unit, glm::radians(degrees.x), glm::dvec3(1, 0, 0)) *
                               glm::rotate(unit, glm::radians(degrees.y), glm::dvec3(0, 0, 1)) *
                               glm::translate(unit, -skeleton.joints[j].centre);
            }
        }
        return deform(binding, mesh.positions, skinning);
    }

    /// Largest l'/l among edges that are not tiny.
    double longestEdge(const std::vector<glm::dvec3>& points) const {
        const double least = 1e-3 * mesh.size();
        double longest = 0.0;
        std::size_t corner = 0;
        for (const std::uint32_t size : mesh.faceSizes) {
            for (std::uint32_t k = 0; k < size; ++k) {
                const std::uint32_t a = mesh.faceVertices[corner + k];
                const std::uint32_t b = mesh.faceVertices[corner + (k + 1) % size];
                const double rest = glm::distance(mesh.positions[a], mesh.positions[b]);
                if (rest < least) continue;
                longest = std::max(longest,
                                   static_cast<double>(glm::distance(points[a], points[b])) / rest);
            }
            corner += size;
        }
        return longest;
    }

    SkinMesh mesh;
    RestSkeleton skeleton;
    Binding binding;
    BindReport report;
};

} // namespace

TEST_P(RealBody, IsBoundWhole) {
    expectSound(binding);
    EXPECT_EQ(report.unassigned, 0u);
    EXPECT_EQ(report.shells, GetParam().shells) << report.text();
    EXPECT_LE(report.influencesPerVertex, 2.1) << report.text();
    for (const char* name : {"Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot", "LeftArm",
                             "RightForeArm", "LeftUpLeg", "RightLeg"})
        EXPECT_GE(
            std::count(binding.regions.begin(), binding.regions.end(), jointCalled(binding, name)),
            8) // all that the sparse body has between elbow and wrist
            << name << "\n"
            << report.text();
}

TEST_P(RealBody, HasOnePatchOfARegionOnEachShell) {
    EXPECT_EQ(severedPatches(mesh, binding.regions), 0u);
}

TEST_P(RealBody, DoesNotTearInExtremePoses) {
    const auto reach = posed({{"LeftArm", {0, 110}}, {"RightArm", {0, -110}}, {"Spine", {-30, 0}}});
    EXPECT_LT(longestEdge(reach), GetParam().longestReach);
    const auto crouch = posed({{"LeftUpLeg", {-110, 0}},
                               {"RightUpLeg", {-60, -30}},
                               {"LeftLeg", {120, 0}},
                               {"RightLeg", {90, 0}},
                               {"LeftForeArm", {-100, 0}},
                               {"Neck", {30, 0}}});
    EXPECT_LT(longestEdge(crouch), 3.0);
}

INSTANTIATE_TEST_SUITE_P(All, RealBody, testing::ValuesIn(kBodies),
                         [](const auto& body) { return std::string(body.param.name); });
