// SPDX-License-Identifier: GPL-3.0-or-later
//
// Real bodies, bound with default settings.
#include "Patches.h"
#include "Ratios.h"
#include "Shapes.h"
#include "SharedBody.h"

#include <osgSkin/Deform>
#include <osgSkinBind/Bind>
#include <osgSkinBind/RigidJoints>

#include <glm/geometric.hpp>
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

TEST_P(RealBody, AssignsEveryVertex) {
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
