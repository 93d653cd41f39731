// SPDX-License-Identifier: GPL-3.0-or-later
#include "PeopleFigures.h"

#include "SampledSurface.h"

#include <osgSkin/Error>

#include <TextFile.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace {

using namespace quality;

constexpr double kTubeRadius = 0.06, kKnee = 0.5;

/// A leg of a person: hip at .9 m, knee at .5 m, ankle at .1 m.
osgSkin::RestSkeleton legRig() {
    osgSkin::RestSkeleton rig;
    rig.add("Hips", -1, glm::dvec3(0, 1.0, 0));
    rig.add("LeftUpLeg", 0, glm::dvec3(0, 0.9, 0));
    rig.add("LeftLeg", 1, glm::dvec3(0, kKnee, 0));
    rig.add("LeftFoot", 2, glm::dvec3(0, 0.1, 0));
    return rig;
}

/// A tube around that leg; its points are the template's.
Scan tube(double radius = kTubeRadius) {
    constexpr std::uint32_t kAround = 24, kAlong = 61;
    Scan scan;
    for (std::uint32_t k = 0; k < kAlong; ++k)
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const double angle = 2.0 * glm::pi<double>() * i / kAround;
            scan.points.emplace_back(radius * std::cos(angle), double(k) / (kAlong - 1),
                                     radius * std::sin(angle));
            if (k == 0) continue;
            const std::uint32_t next = (i + 1) % kAround, below = (k - 1) * kAround,
                                at = k * kAround;
            for (const std::uint32_t corner :
                 {below + i, at + i, at + next, below + i, at + next, below + next})
                scan.triangles.push_back(corner);
        }
    scan.vertexOf.resize(scan.points.size());
    std::iota(scan.vertexOf.begin(), scan.vertexOf.end(), 0u);
    return scan;
}

/// The leg's joint at a height, with rigid parts.
std::uint32_t regionAt(double y) {
    return y > 0.9 ? 0u : y > kKnee ? 1u : y > 0.1 ? 2u : 3u;
}

std::vector<std::uint32_t> regionsOf(const Scan& scan) {
    std::vector<std::uint32_t> regions;
    for (const glm::dvec3& point : scan.points) regions.push_back(regionAt(point.y));
    return regions;
}

/// Hip and knee bent about x, the whole moved.
std::vector<glm::dmat4> bent(double hip, double knee) {
    const osgSkin::RestSkeleton rig = legRig();
    const auto about = [&](std::size_t joint, double degrees) {
        const glm::dmat4 unit(1.0);
        const glm::dvec3 centre = rig.joints[joint].centre;
        return glm::translate(unit, centre) *
               glm::rotate(unit, glm::radians(degrees), glm::dvec3(1, 0, 0)) *
               glm::translate(unit, -centre);
    };
    std::vector<glm::dmat4> skinning;
    skinning.push_back(glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, 0.1, -0.2)));
    skinning.push_back(skinning[0] * about(1, hip));
    skinning.push_back(skinning[1] * about(2, knee));
    skinning.push_back(skinning[2]);
    return skinning;
}

/// The tube's scan in a pose of rigid parts.
Scan rigidScan(const std::vector<glm::dmat4>& skinning, double scale) {
    Scan scan = tube();
    for (glm::dvec3& point : scan.points)
        point = scale * glm::dvec3(skinning[regionAt(point.y)] * glm::dvec4(point, 1.0));
    return scan;
}

/// The tube with weights that change over a radius at the joints.
PersonSkin blendedLeg() {
    const Scan rest = tube();
    PaintedBody body;
    body.name = "leg";
    body.rig = legRig();
    body.mesh.positions = rest.points;
    body.mesh.faceVertices = rest.triangles;
    body.mesh.faceSizes.assign(rest.triangles.size() / 3, 3);
    for (const glm::dvec3& point : rest.points) {
        std::vector<osgSkin::JointWeight> weights;
        double left = 1.0;
        for (const double height : {0.1, kKnee, 0.9}) { // the joints below first
            const double above = glm::smoothstep(-1.0, 1.0, (point.y - height) / kTubeRadius);
            const auto joint = static_cast<std::uint32_t>(height < 0.2 ? 3 : height < 0.6 ? 2 : 1);
            if (left * (1.0 - above) > 0.0) weights.push_back({joint, left * (1.0 - above)});
            left *= above;
        }
        if (left > 0.0) weights.push_back({0, left});
        body.painted.push_back(weights);
    }
    return {"LBS", makeSubject(body, Ratios::Painted), Method::Linear};
}

TEST(SampledSurface, MeasuresDistanceFromCurvedSurface) {
    const Scan scan = tube();
    const SampledSurface surface(scan.points, scan.triangles);
    // Flat triangles would be .5 mm off in the middle between two edges.
    const double middle = glm::pi<double>() / 24.0;
    const glm::dvec3 outwards(std::cos(middle), 0.0, std::sin(middle));
    for (const double distance : {-0.005, -0.001, 0.0, 0.003, 0.01}) {
        const glm::dvec3 point = (kTubeRadius + distance) * outwards + glm::dvec3(0, 0.507, 0);
        EXPECT_NEAR(surface.nearest(point, outwards).distance, distance, 5e-5);
    }
}

TEST(SampledSurface, PrefersSurfaceThatFacesTheSameDirection) {
    // Two plates, 4 mm apart, that face away from each other.
    compare::Points points;
    for (const double y : {0.0, 0.004})
        for (const double x : {-0.02, 0.02})
            for (const double z : {-0.02, 0.02}) points.emplace_back(x, y, z);
    const SampledSurface surface(points, {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6});
    const glm::dvec3 down(0, -1, 0), point(0.003, 0.003, 0.003);
    EXPECT_NEAR(surface.nearest(point, down).distance, -0.003, 1e-9);
    EXPECT_NEAR(surface.nearest(point, -down).distance, -0.001, 1e-9);
}

TEST(SampledSurface, HidesWhatIsInside) {
    const Scan scan = tube();
    const SampledSurface surface(scan.points, scan.triangles);
    const std::vector<double> seen =
        surface.visibility({{kTubeRadius, 0.5, 0.0}, {0.0, 0.5, kTubeRadius}, {0.0, 0.5, 0.0}});
    EXPECT_GE(seen[0], 0.9);
    EXPECT_GE(seen[1], 0.9);
    EXPECT_LE(seen[2], 0.2); // one of 16 views may look into the open end
}

TEST(RigidParts, FindThePoseAndTheScaleOfAScan) {
    const CapturedPerson person{"leg", tube(), {}};
    const RigidParts parts(person, legRig(), regionsOf(person.rest));
    const std::vector<glm::dmat4> expected = bent(-40.0, 80.0);
    const RigidParts::Pose pose = parts.solve(legRig(), rigidScan(expected, 0.9));
    EXPECT_NEAR(pose.scale, 0.9, 1e-3);
    const double heights[] = {0.95, 0.7, 0.3, 0.05}; // within each part
    for (std::size_t j = 0; j < expected.size(); ++j) {
        const glm::dvec4 point(kTubeRadius, heights[j], 0.0, 1.0);
        EXPECT_LT(glm::distance(pose.skinning[j] * point, expected[j] * point), 2e-3) << j;
    }
}

TEST(RigidParts, MoveAJointToWhereItTurns) {
    CapturedPerson person{"leg", tube(), {}};
    for (const double knee : {40.0, 70.0, 100.0})
        person.poses.push_back(rigidScan(bent(-30.0, knee), 1.1));
    osgSkin::RestSkeleton wrong = legRig();
    wrong.joints[2].centre += glm::dvec3(0.0, 0.02, -0.02);
    const RigidParts parts(person, wrong, regionsOf(person.rest));
    EXPECT_LT(glm::distance(parts.turnedJoints().joints[2].centre, legRig().joints[2].centre),
              0.003);
}

TEST(PeopleFigures, MeasureHowFarASkinIsFromAScan) {
    const PersonSkin leg = blendedLeg();
    CapturedPerson person{"leg", tube(), {}};
    RigidParts::Pose pose;
    pose.skinning = bent(0.0, 70.0);
    pose.scale = 0.9;
    for (const double outwards : {0.0, 0.003, -0.002}) {
        Scan scan = person.rest;
        scan.points = deform(leg.subject, leg.method, pose.skinning);
        const compare::Points normals = skinNormals(scan.points, scan.triangles);
        for (std::size_t v = 0; v < scan.points.size(); ++v)
            scan.points[v] = pose.scale * (scan.points[v] + outwards * normals[v]);
        const auto distances = measureDistances(person, {leg}, scan, pose);
        ASSERT_EQ(distances.front().size(), 1u); // only the knee is bent
        EXPECT_EQ(distances.front().front().joint, "knee");
        EXPECT_NEAR(distances.front().front().distance, 1000.0 * std::abs(outwards), 0.3);
        EXPECT_LT(distances.front().front().normals, 4.0);
    }
}

/// What readPerson() says of a folder.
std::string refusal(const std::string& folder) {
    try {
        readPerson(folder, 0);
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
    return {};
}

TEST(CapturedPeople, RefusalNamesTheFileThatIsMissingOrWrong) {
    const std::string folder = testing::TempDir() + "people";
    std::filesystem::create_directories(folder + "/corres");
    EXPECT_EQ(refusal(folder),
              folder + "/tr_reg_000.off: missing, expected FAUST's scans with 5,000 vertices, "
                       "tr_reg_000.off to tr_reg_099.off");
    test::saveText("people/tr_reg_000.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(refusal(folder), folder + "/corres/tr_reg_000.vts: missing, expected a vertex for "
                                        "each template point");
    test::saveText("people/corres/tr_reg_000.vts", "1\n3\n4\n");
    EXPECT_EQ(refusal(folder),
              folder + "/corres/tr_reg_000.vts: line 3: expected a vertex from 1 to 3");
    test::saveText("people/corres/tr_reg_000.vts", "1\n3\nthree\n");
    EXPECT_EQ(refusal(folder), folder + "/corres/tr_reg_000.vts: line 3: expected a number");
}

TEST(CapturedPeople, HaveTheirSizeAtRest) {
    const std::string folder = testing::TempDir() + "sized/Dataset/FAUST/vtx_5k";
    std::filesystem::create_directories(folder + "/corres");
    for (int k = 0; k < 10; ++k) {
        const std::string name = "tr_reg_00" + std::to_string(k);
        test::saveText("sized/Dataset/FAUST/vtx_5k/" + name + ".off",
                       "OFF\n3 1 0\n0 0 0\n1 0 0\n0 " + std::to_string(k + 1) + " 0\n3 0 1 2\n");
        test::saveText("sized/Dataset/FAUST/vtx_5k/corres/" + name + ".vts", "3\n1\n2\n3\n");
    }
    const CapturedPerson person = readPerson(testing::TempDir() + "sized", 0);
    ASSERT_EQ(person.poses.size(), 9u);
    EXPECT_NEAR(person.rest.points[2].y, 1.75, 1e-12);
    EXPECT_NEAR(person.poses[3].points[2].y, 5.0 * 1.75, 1e-9);
    EXPECT_EQ(person.poses[3].vertexOf, (std::vector<std::uint32_t>{2, 0, 1, 2}));
}

} // namespace
