// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shells on top of others: clothes on the thrower, and shells that are not clothes.
#include "KnownBody.h"
#include "Shapes.h"
#include "Stretches.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace osgSkin;

namespace {

/// From the shins to the collar, and to the forearms.
bool isDressed(const glm::dvec3& p) {
    return p.y > 0.25 && p.y < 1.45 && std::abs(p.x) < 0.5;
}

/// A garment with an inner layer, sewn to the outer one along the rims.
SkinMesh lined(const SkinMesh& outside, const SkinMesh& inside) {
    SkinMesh result = outside;
    const auto count = static_cast<std::uint32_t>(outside.positions.size());
    result.positions.insert(result.positions.end(), inside.positions.begin(),
                            inside.positions.end());
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t t = 0; t + 2 < outside.faceVertices.size(); t += 3)
        for (std::size_t k = 3; k-- > 0;) {
            result.faceVertices.push_back(count + inside.faceVertices[t + k]);
            edges.emplace(outside.faceVertices[t + k], outside.faceVertices[t + (k + 1) % 3]);
        }
    for (const auto& [a, b] : edges)
        if (edges.count({b, a}) == 0)
            for (const std::uint32_t v : {b, a, count + a, b, count + a, count + b})
                result.faceVertices.push_back(v);
    result.faceSizes.assign(result.faceVertices.size() / 3, 3);
    return result;
}

glm::dquat rotation(double degrees, const glm::dvec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
}

/// A body with something on it, posed in several ways.
struct Dressed {
    KnownBody body;
    SkinMesh naked, cloth;

    Dressed(const KnownBody& bare, SkinMesh on)
        : body(bare), naked(bare.mesh), cloth(std::move(on)) {
        body.mesh = shapes::joined(naked, cloth);
    }

    /// For each garment vertex, the body vertex that is nearest at rest.
    std::vector<std::size_t> below() const {
        std::vector<std::size_t> result;
        for (const glm::dvec3& p : cloth.positions) {
            const auto distance = [&](const glm::dvec3& q) { return glm::distance(p, q); };
            result.push_back(static_cast<std::size_t>(
                std::min_element(naked.positions.begin(), naked.positions.end(),
                                 [&](const glm::dvec3& q, const glm::dvec3& r) {
                                     return distance(q) < distance(r);
                                 }) -
                naked.positions.begin()));
        }
        return result;
    }

    static std::vector<std::map<std::string, glm::dquat>> poses() {
        const glm::dvec3 x(1, 0, 0), z(0, 0, 1);
        return {{{"LeftArm", rotation(100, z)}, {"RightArm", rotation(40, z)}},
                {{"LeftArm", rotation(-80, {0, 1, 0})}, {"Spine", rotation(-30, x)}},
                {{"LeftUpLeg", rotation(-90, x)},
                 {"LeftLeg", rotation(100, x)},
                 {"Spine", rotation(30, x)}}};
    }

    /// The largest increase of a garment vertex's distance from the skin, and the 99.9th percentile
    /// of its edges' l'/l relative to the skin's; each the maximum over the poses.
    std::pair<double, double> leaves() const {
        const std::vector<std::size_t> skin = below();
        const std::size_t first = naked.positions.size();
        double most = 0.0, stretched = 0.0;
        for (const auto& pose : poses()) {
            const SkinMesh posed = body.posed(pose).mesh;
            SkinMesh clothPosed = cloth, skinPosed = naked;
            std::copy_n(posed.positions.begin(), first, skinPosed.positions.begin());
            for (std::size_t v = 0; v < skin.size(); ++v) {
                const double rest = glm::distance(cloth.positions[v], naked.positions[skin[v]]);
                clothPosed.positions[v] = posed.positions[first + v];
                most = std::max(
                    most,
                    glm::distance(posed.positions[first + v], posed.positions[skin[v]]) - rest);
            }
            stretched = std::max(stretched, percentile999(stretches(cloth, clothPosed)) /
                                                percentile999(stretches(naked, skinPosed)));
        }
        return {most, stretched};
    }
};

} // namespace

TEST(Layers, ClothFollowsTheSkinBelow) {
    const KnownBody thrower = KnownBody::thrower();
    for (const double distance : {0.008, 0.014}) {
        const auto [most, stretched] =
            Dressed(thrower, shapes::garment(thrower.mesh, isDressed, distance)).leaves();
        EXPECT_LT(most, 0.02) << distance;
        EXPECT_LT(stretched, 1.25) << distance;
    }
}

TEST(Layers, LinedClothFollowsTheSkinBelow) {
    const KnownBody thrower = KnownBody::thrower();
    const SkinMesh cloth = lined(shapes::garment(thrower.mesh, isDressed, 0.01),
                                 shapes::garment(thrower.mesh, isDressed, 0.006));
    const auto [most, stretched] = Dressed(thrower, cloth).leaves();
    EXPECT_LT(most, 0.02);
    EXPECT_LT(stretched, 1.25);
}

TEST(Layers, SleeveBesideTheBodyFollowsItsArm) {
    // Nearer to the trunk than to its own arm.
    const auto isSleeve = [](const glm::dvec3& p) { return p.x > 1.1 && p.y < -0.2 && p.y > -3.0; };
    KnownBody bare{shapes::hangingArms(), shapes::hangingArmsSkeleton()};
    const SkinMesh sleeve = shapes::garment(bare.mesh, isSleeve, 0.15);
    const Dressed dressed(bare, sleeve);
    const SkinMesh posed = dressed.body.posed({{"leftArm", rotation(70, {0, 0, 1})}}).mesh;
    const std::size_t first = bare.mesh.positions.size();
    const glm::dvec3 shoulder(1.6, 1.4, 0);
    for (std::size_t v = 0; v < sleeve.positions.size(); ++v) {
        const glm::dvec3 arm =
            rotation(70, {0, 0, 1}) * (sleeve.positions[v] - shoulder) + shoulder;
        EXPECT_LT(glm::distance(posed.positions[first + v], arm), 0.15) << v;
    }
}

TEST(Layers, ShellWithItsOwnJointKeepsIt) {
    // A ball with its own joint, half outside a cylinder, like an eye.
    SkinMesh body = shapes::cylinder();
    const SkinMesh ball = shapes::voxelSurface(
        [](int x, int y, int z) {
            return (x + .5) * (x + .5) + (y + .5) * (y + .5) + (z + .5) * (z + .5) < 9.0;
        },
        4, 0.1);
    const std::size_t first = body.positions.size();
    const glm::dvec3 centre(0, 6, 0.9);
    body = shapes::joined(body, shapes::moved(ball, centre));
    RestSkeleton skeleton = shapes::chainAlongY({1.0, 4.0}, 7.0);
    shapes::addJoint(skeleton, "eye", skeleton.joints.back().name, centre);
    skeleton.joints.back().tip = centre + glm::dvec3(0, 0, 0.3);
    const Binding binding = bind(body, skeleton);
    const auto eye = static_cast<std::uint32_t>(skeleton.find("eye"));
    double sum = 0.0;
    for (std::size_t v = first; v < body.positions.size(); ++v) {
        const Influence& last = binding.influences[binding.firstInfluence[v + 1] - 1];
        if (last.joint == eye) sum += last.bend;
    }
    EXPECT_GT(sum / static_cast<double>(body.positions.size() - first), 0.4);
}

TEST(Layers, ShellOnALooseLayerIsBound) {
    // A belt around a skirt, far from the body, which the skirt touches at its upper end.
    const SkinMesh body = shapes::cylinder(8.0, 16);
    SkinMesh skirt = shapes::garment(
        body, [](const glm::dvec3& p) { return p.y > 0.6 && p.y < 6.0; }, 0.05);
    for (glm::dvec3& p : skirt.positions) {
        const double wide = 1.0 + 0.5 * (5.5 - p.y);
        p = {wide * p.x, p.y, wide * p.z};
    }
    const SkinMesh belt = shapes::garment(
        skirt, [](const glm::dvec3& p) { return p.y > 1.0 && p.y < 2.0; }, 0.05);
    const SkinMesh mesh = shapes::joined(shapes::joined(body, skirt), belt);
    const Binding binding = bind(mesh, shapes::chainAlongY({1.1, 4.1}, 7.0));
    EXPECT_NO_THROW(binding.validate());
    const std::size_t first = body.positions.size();
    for (std::size_t v = 0; v < belt.positions.size(); ++v) {
        const std::size_t at = first + skirt.positions.size() + v;
        EXPECT_LT(binding.regions[at], binding.joints.size());
    }
}

TEST(Layers, ReportCountsLayeredVertices) {
    const KnownBody thrower = KnownBody::thrower();
    const SkinMesh cloth = shapes::garment(thrower.mesh, isDressed, 0.008);
    BindReport report;
    bind(shapes::joined(thrower.mesh, cloth), thrower.truth, {}, &report);
    EXPECT_GT(report.layeredVertices, cloth.positions.size() * 95 / 100);
    EXPECT_LE(report.layeredVertices, cloth.positions.size());
    EXPECT_NE(report.text().find("vertices on others " + std::to_string(report.layeredVertices)),
              std::string::npos);
    bind(thrower.mesh, thrower.truth, {}, &report);
    EXPECT_EQ(report.layeredVertices, 0u);
}
