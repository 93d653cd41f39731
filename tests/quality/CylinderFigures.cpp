// SPDX-License-Identifier: MIT
#include "CylinderFigures.h"

#include "Report.h"

#include <osgSkinBind/Bind>

#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace quality {

namespace {

constexpr std::uint32_t kSides = 48;
constexpr std::uint32_t kRings = 65; ///< along y = -4..4, an eighth apart

osgSkin::SkinMesh makeMesh() {
    osgSkin::SkinMesh mesh;
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
        for (std::uint32_t side = 0; side < kSides; ++side) {
            const double angle = 2.0 * glm::pi<double>() * side / kSides;
            mesh.positions.emplace_back(std::cos(angle), 0.125 * ring - 4.0, -std::sin(angle));
        }
    const auto addFace = [&](const std::vector<std::uint32_t>& corners) {
        mesh.faceSizes.push_back(static_cast<std::uint32_t>(corners.size()));
        mesh.faceVertices.insert(mesh.faceVertices.end(), corners.begin(), corners.end());
    };
    const auto at = [](std::uint32_t ring, std::uint32_t side) {
        return ring * kSides + side % kSides;
    };
    for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring)
        for (std::uint32_t side = 0; side < kSides; ++side)
            addFace(
                {at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)});
    const auto last = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.emplace_back(0.0, -4.0, 0.0);
    mesh.positions.emplace_back(0.0, 4.0, 0.0);
    for (std::uint32_t side = 0; side < kSides; ++side) {
        addFace({last, at(0, side + 1), at(0, side)});
        addFace({last + 1, at(kRings - 1, side), at(kRings - 1, side + 1)});
    }
    return mesh;
}

Subject makeCylinder() {
    Subject cylinder;
    cylinder.name = "cylinder";
    cylinder.mesh = makeMesh();
    cylinder.rig.joints = {{"lower", -1, {0, -4, 0}, {}}, {"upper", 0, {0, 0, 0}, {}}};
    cylinder.rig.joints.back().tip = glm::dvec3(0, 4, 0);
    // The paper's model without shapes, which press the fold flat; the volume then counts
    // self-overlapping parts twice.
    osgSkin::BindOptions options;
    options.shapes = osgSkin::BindOptions::Shapes::None;
    cylinder.binding = osgSkin::bind(cylinder.mesh, cylinder.rig, options, &cylinder.report);
    cylinder.rest = cylinder.mesh.positions;
    cylinder.model = modelOf(cylinder);
    cylinder.triangles = cylinder.mesh.triangles();
    cylinder.edges = compare::faceEdges(cylinder.mesh.faceSizes, cylinder.mesh.faceVertices);
    for (const glm::dvec3& p : cylinder.rest) {
        const double t = std::clamp(0.5 * (p.y + 1.0), 0.0, 1.0);
        const double weight = t * t * (3.0 - 2.0 * t); // eq. 5
        cylinder.weights.add({{0, 1.0 - weight}, {1, weight}});
    }
    return cylinder;
}

double leastRing(const Subject& cylinder, const compare::Points& posed) {
    double least = 1.0;
    for (std::uint32_t ring = 0; ring < kRings; ++ring) {
        std::vector<std::uint32_t> loop;
        for (std::uint32_t side = 0; side < kSides; ++side) loop.push_back(ring * kSides + side);
        least = std::min(least,
                         compare::loopArea(posed, loop) / compare::loopArea(cylinder.rest, loop));
    }
    return least;
}

CylinderPose measure(const Subject& cylinder, double bend, double twist) {
    CylinderPose pose{bend, twist, {}, {}, {}};
    const glm::dvec3 axis = bend != 0.0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const auto skinning = singleTurn(cylinder, 1, axis, glm::radians(bend + twist));
    for (const Method method : kMethods) {
        const compare::Points posed = deform(cylinder, method, skinning);
        pose.strain[method] = compare::edgeStrain(cylinder.rest, posed, cylinder.edges).rms;
        pose.volume[method] = compare::enclosedVolume(posed, cylinder.triangles) /
                              compare::enclosedVolume(cylinder.rest, cylinder.triangles);
        pose.leastArea[method] = leastRing(cylinder, posed);
    }
    return pose;
}

} // namespace

std::vector<CylinderPose> measureCylinder() {
    const Subject cylinder = makeCylinder();
    std::vector<CylinderPose> poses;
    for (int degrees = 30; degrees <= 330; degrees += 30)
        poses.push_back(measure(cylinder, 0.0, degrees));
    for (int degrees = 30; degrees <= 150; degrees += 30)
        poses.push_back(measure(cylinder, degrees, 0.0));
    return poses;
}

double leastTwistArea(const std::vector<CylinderPose>& poses) {
    double least = 1.0;
    for (const CylinderPose& pose : poses)
        if (pose.bend == 0.0) least = std::min(least, pose.leastArea[Method::Ours]);
    return least;
}

double mostVolumeError(const std::vector<CylinderPose>& poses) {
    double most = 0.0;
    for (const CylinderPose& pose : poses)
        if (pose.bend > 0.0 && pose.bend <= 120.0)
            most = std::max(most, std::abs(pose.volume[Method::Ours] - 1.0));
    return most;
}

namespace {

std::vector<Bar> bars(const std::vector<CylinderPose>& poses) {
    return {{"least area in twists", leastTwistArea(poses), false, 0.99},
            {"volume error to bend 120", mostVolumeError(poses), true, 0.01}};
}

} // namespace

void printTable(const std::vector<CylinderPose>& poses, std::ostream& out) {
    out << format("%-20s%30s%30s%30s\n%20s", "cylinder", "strain RMS", "volume", "least area", "");
    for (int figure = 0; figure < 3; ++figure)
        for (const Method method : kMethods) out << format("%10s", nameOf(method));
    out << '\n';
    for (const CylinderPose& pose : poses) {
        out << format("  %-5s %-12.0f", pose.bend > 0.0 ? "bend" : "twist", pose.bend + pose.twist);
        for (const auto* figure : {&pose.strain, &pose.volume, &pose.leastArea})
            for (const Method method : kMethods) out << format("%10.3f", (*figure)[method]);
        out << '\n';
    }
    for (const Bar& bar : bars(poses)) out << lineOf(bar);
    out << '\n';
}

nlohmann::ordered_json toJson(const std::vector<CylinderPose>& poses) {
    nlohmann::ordered_json json = {{"poses", nlohmann::json::array()},
                                   {"bars", nlohmann::json::array()}};
    for (const CylinderPose& pose : poses)
        json["poses"].push_back(
            {{"bend", pose.bend},
             {"twist", pose.twist},
             {"edgeStrainRms", perMethod([&](Method m) { return pose.strain[m]; })},
             {"volume", perMethod([&](Method m) { return pose.volume[m]; })},
             {"leastArea", perMethod([&](Method m) { return pose.leastArea[m]; })}});
    for (const Bar& bar : bars(poses)) json["bars"].push_back(toJson(bar));
    return json;
}

} // namespace quality
