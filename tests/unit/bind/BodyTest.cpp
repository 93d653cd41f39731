// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "SharedBody.h"

#include <osgSkin/Deform>
#include <osgSkinBind/Bind>
#include <osgSkinBind/RigidJoints>
#include <osgSkinBind/RigidSplit>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>

using namespace osgSkin;

namespace {

struct Named {
    const char* mesh;
    const char* rig;
    /// How far to move every point from the neutral body towards the male one, 0 to 1; used in
    /// place of `mesh`'s own points.
    double towardsMale = 0.0;
    const char* name = nullptr;
};

void PrintTo(const Named& named, std::ostream* out) {
    *out << named.mesh << " " << named.rig;
}

SkinMesh meshCalled(const std::string& name) {
    return shared::readObj(shared::makehuman() / "body" / (name + ".obj"));
}

RestSkeleton skeletonCalled(const std::string& name) {
    return shared::readJoints(shared::makehuman() / "rig" / ("joints_" + name + ".json"));
}

void move(glm::dvec3& from, const glm::dvec3& to, double share) {
    from += share * (to - from);
}

/// Real bodies, without preparation.
class Body : public testing::TestWithParam<Named> {
protected:
    void SetUp() override {
        const auto meshFile =
            shared::makehuman() / "body" / (std::string(GetParam().mesh) + ".obj");
        const auto rigFile =
            shared::makehuman() / "rig" / ("joints_" + std::string(GetParam().rig) + ".json");
        if (!std::filesystem::exists(meshFile) || !std::filesystem::exists(rigFile))
            GTEST_SKIP() << "needs " << meshFile << " and " << rigFile;
        mesh = meshCalled(GetParam().mesh);
        skeleton = skeletonCalled(GetParam().rig);
        if (GetParam().towardsMale != 0.0) goTowardsMale(GetParam().towardsMale);
        BindOptions options; // nothing moves fingers, toes and faces
        options.rigid =
            automaticRigidJoints(skeleton, {}, std::vector<bool>(skeleton.joints.size()));
        binding = bind(mesh, skeleton, options, &report);
    }

    /// Mean bend ratio of `joint` over the skin in the middle third of the bone from `from` to
    /// `to`.
    double middleThird(const std::string& from, const std::string& to,
                       const std::string& joint) const {
        const std::size_t a = jointCalled(binding, from), b = jointCalled(binding, to);
        const glm::dvec3 way = binding.joints[b].centre - binding.joints[a].centre;
        double sum = 0.0, count = 0.0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            if (binding.regions[v] != a && binding.regions[v] != b) continue;
            const double s =
                glm::dot(mesh.positions[v] - binding.joints[a].centre, way) / glm::dot(way, way);
            if (s < 1.0 / 3.0 || s > 2.0 / 3.0) continue;
            sum += ratiosOf(binding, v, jointCalled(binding, joint)).bend;
            count += 1.0;
        }
        return sum / count;
    }

    void goTowardsMale(double share) {
        const SkinMesh male = meshCalled("body4k_male");
        const RestSkeleton bones = skeletonCalled("cmu_mb_male");
        ASSERT_EQ(mesh.positions.size(), male.positions.size());
        ASSERT_EQ(skeleton.joints.size(), bones.joints.size());
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            move(mesh.positions[v], male.positions[v], share);
        for (std::size_t j = 0; j < bones.joints.size(); ++j) {
            RestJoint& joint = skeleton.joints[j];
            move(joint.centre, bones.joints[j].centre, share);
            if (joint.tip && bones.joints[j].tip) move(*joint.tip, *bones.joints[j].tip, share);
        }
    }

    SkinMesh mesh;
    RestSkeleton skeleton;
    Binding binding;
    BindReport report;
};

class CmuBody : public Body {};

} // namespace

TEST_P(Body, AssignsEveryVertex) {
    expectSound(binding);
    EXPECT_EQ(report.unassigned, 0u);
    EXPECT_EQ(report.shells, 1u);
    EXPECT_LT(report.influencesPerVertex, 2.1) << report.text();
    std::size_t labelled = 0;
    for (const BindReport::Region& region : report.regions) labelled += region.vertices;
    EXPECT_EQ(labelled, mesh.positions.size());
}

TEST_P(Body, HasRigidHandsFeetAndHead) {
    const std::vector<std::string> rigid =
        automaticRigidJoints(skeleton, {}, std::vector<bool>(skeleton.joints.size()));
    ASSERT_EQ(rigid.size(), 5u);
    const RigidSplit split = splitRigid(mesh, binding, rigid);
    for (const std::string& name : rigid) {
        const std::size_t joint = jointCalled(binding, name);
        const auto faces = std::count(split.faceJoint.begin(), split.faceJoint.end(), joint);
        // Counts the faces in the joint's region, which reaches up to half of the limb above.
        std::size_t corner = 0, own = 0;
        for (const std::uint32_t size : mesh.faceSizes) {
            if (binding.regions[mesh.faceVertices[corner]] == joint) ++own;
            corner += size;
        }
        EXPECT_GT(static_cast<double>(faces), 0.5 * static_cast<double>(own)) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(All, Body,
                         testing::Values(Named{"body4k_neutral", "cmu_mb_neutral"},
                                         Named{"body4k_male", "cmu_mb_male"},
                                         Named{"body_neutral", "cmu_mb_neutral"},
                                         Named{"body4k_male", "game_engine_male"},
                                         Named{"body4k_neutral", "default_neutral"}),
                         [](const auto& named) {
                             return std::string(named.param.mesh) + "_" + named.param.rig;
                         });

TEST_P(CmuBody, LimbsStayRigidInTheMiddle) {
    const char* const bones[][2] = {
        {"Arm", "ForeArm"}, {"ForeArm", "Hand"}, {"UpLeg", "Leg"}, {"Leg", "Foot"}};
    for (const std::string side : {"Left", "Right"})
        for (const auto& [own, next] : bones) {
            EXPECT_GE(middleThird(side + own, side + next, side + own), 0.965) << side + own;
            EXPECT_LE(middleThird(side + own, side + next, side + next), 0.01) << side + own;
        }
}

TEST_P(CmuBody, RegionsAgreeWithPaintedWeights) {
    const std::string mesh4k = GetParam().mesh;
    const auto file = shared::makehuman() / "weights" /
                      (mesh4k.substr(0, mesh4k.find('_')) + "_weights_cmu_mb.json");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file;
    const auto weights = shared::readWeights(file, skeleton, mesh.positions.size());

    // A joint's region is compared along the joint tree; joints below a rigid one and joints of no
    // length count as the one above.
    const std::vector<std::string> rigid =
        automaticRigidJoints(skeleton, {}, std::vector<bool>(skeleton.joints.size()));
    std::vector<std::size_t> shown(skeleton.joints.size());
    for (std::size_t j = 0; j < shown.size(); ++j) {
        shown[j] = j;
        if (skeleton.joints[j].parent < 0) continue;
        const std::size_t above = shown[static_cast<std::size_t>(skeleton.joints[j].parent)];
        const bool inRigid =
            std::count(rigid.begin(), rigid.end(), skeleton.joints[above].name) > 0;
        if (inRigid || skeleton.joints[j].centre == skeleton.joints[above].centre) shown[j] = above;
    }
    const auto parent = [&](std::size_t j) {
        const int p = skeleton.joints[j].parent;
        return p < 0 ? j : shown[static_cast<std::size_t>(p)];
    };
    std::size_t far = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const auto most = std::max_element(weights[v].begin(), weights[v].end());
        const std::size_t painted = shown[static_cast<std::size_t>(most - weights[v].begin())];
        const std::size_t ours = shown[binding.regions[v]];
        if (ours != painted && parent(ours) != painted && parent(painted) != ours) ++far;
    }
    EXPECT_LT(static_cast<double>(far), 0.025 * static_cast<double>(mesh.positions.size()));
}

TEST_P(CmuBody, WristTwistSpreadsOverTheForearm) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    const std::vector<std::uint32_t> corners = mesh.triangles();
    for (std::size_t i = 0; i < corners.size(); ++i)
        edges.insert(std::minmax(corners[i], corners[i - i % 3 + (i + 1) % 3]));

    const std::vector<glm::dmat4> unmoved(binding.joints.size(), glm::dmat4(1.0));
    const std::vector<glm::dvec3> rest = deform(binding, mesh.positions, unmoved); // rounded alike
    struct Limit {
        double degrees, strain;
    };
    const std::size_t hand = jointCalled(binding, "LeftHand");
    for (const Limit& limit : {Limit{60, 0.03}, Limit{120, 0.07}, Limit{170, 0.105}}) {
        std::vector<glm::dmat4> skinning(binding.joints.size(), glm::dmat4(1.0));
        const glm::dvec3 c = binding.joints[hand].centre;
        for (std::size_t j = hand; j < skinning.size(); ++j)
            if (skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(hand)))
                skinning[j] = glm::translate(glm::dmat4(1.0), c) *
                              glm::rotate(glm::dmat4(1.0), glm::radians(limit.degrees),
                                          binding.joints[hand].twistAxis) *
                              glm::translate(glm::dmat4(1.0), -c);
        const std::vector<glm::dvec3> posed = deform(binding, mesh.positions, skinning);
        double sum = 0.0, count = 0.0;
        for (const auto& [a, b] : edges) {
            const double strain =
                glm::distance(posed[a], posed[b]) / glm::distance(rest[a], rest[b]) - 1.0;
            if (std::abs(strain) < 1e-5) continue; // moved as a whole, or not at all
            sum += strain * strain;
            count += 1.0;
        }
        EXPECT_GT(count, 100.0);
        EXPECT_LE(std::sqrt(sum / count), limit.strain) << "at " << limit.degrees << " degrees";
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, CmuBody,
    testing::Values(Named{"body4k_neutral", "cmu_mb_neutral", 0.0, "Neutral"},
                    Named{"body4k_male", "cmu_mb_male", 0.0, "Male"},
                    Named{"body4k_neutral", "cmu_mb_neutral", -1.0, "AwayFromMale"},
                    Named{"body4k_neutral", "cmu_mb_neutral", 0.5, "HalfWay"},
                    Named{"body4k_neutral", "cmu_mb_neutral", 1.5, "BeyondMale"}),
    [](const auto& named) { return std::string(named.param.name); });
