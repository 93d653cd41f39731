// SPDX-License-Identifier: GPL-3.0-or-later
#include "Shapes.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace shapes {
namespace {

void addFace(osgSkin::SkinMesh& mesh, const std::vector<std::uint32_t>& corners) {
    mesh.faceSizes.push_back(static_cast<std::uint32_t>(corners.size()));
    mesh.faceVertices.insert(mesh.faceVertices.end(), corners.begin(), corners.end());
}

} // namespace

osgSkin::SkinMesh cylinder(double length, int sides) {
    osgSkin::SkinMesh mesh;
    const int rings = static_cast<int>(std::lround(length / 0.25)) + 1;
    for (int ring = 0; ring < rings; ++ring)
        for (int side = 0; side < sides; ++side) {
            const double angle = 2.0 * glm::pi<double>() * side / sides;
            mesh.positions.emplace_back(std::cos(angle), 0.25 * ring, std::sin(angle));
        }
    const auto at = [sides](int ring, int side) {
        return static_cast<std::uint32_t>(ring * sides + side % sides);
    };
    for (int ring = 0; ring + 1 < rings; ++ring)
        for (int side = 0; side < sides; ++side)
            addFace(mesh, {at(ring, side), at(ring + 1, side), at(ring + 1, side + 1),
                           at(ring, side + 1)});
    std::vector<std::uint32_t> bottom, top;
    for (int side = 0; side < sides; ++side) {
        bottom.push_back(at(0, side));
        top.push_back(at(rings - 1, sides - side));
    }
    addFace(mesh, bottom);
    addFace(mesh, top);
    return mesh;
}

osgSkin::RestSkeleton chainAlongY(const std::vector<double>& heights, double end) {
    osgSkin::RestSkeleton skeleton;
    for (std::size_t j = 0; j < heights.size(); ++j)
        skeleton.joints.push_back(
            {"joint" + std::to_string(j), static_cast<int>(j) - 1, {0, heights[j], 0}, {}});
    skeleton.joints.back().tip = glm::dvec3(0, end, 0);
    return skeleton;
}

osgSkin::SkinMesh voxelSurface(const Filled& filled, int range, double cell) {
    osgSkin::SkinMesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> known;
    const auto corner = [&](std::array<int, 3> c) {
        const auto [place, added] =
            known.emplace(c, static_cast<std::uint32_t>(mesh.positions.size()));
        if (added) mesh.positions.push_back(cell * glm::dvec3(c[0], c[1], c[2]));
        return place->second;
    };
    for (int x = -range; x < range; ++x)
        for (int y = -range; y < range; ++y)
            for (int z = -range; z < range; ++z) {
                if (!filled(x, y, z)) continue;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    for (const int way : {0, 1}) {
                        std::array<int, 3> next{x, y, z};
                        next[axis] += way ? 1 : -1;
                        if (filled(next[0], next[1], next[2])) continue;
                        std::array<int, 3> base{x, y, z};
                        base[axis] += way;
                        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                        std::array<int, 3> alongU = base, both = base, alongV = base;
                        ++alongU[u], ++both[u], ++both[v], ++alongV[v];
                        if (way)
                            addFace(mesh,
                                    {corner(base), corner(alongU), corner(both), corner(alongV)});
                        else
                            addFace(mesh,
                                    {corner(base), corner(alongV), corner(both), corner(alongU)});
                    }
            }
    return mesh;
}

osgSkin::SkinMesh hangingArms() {
    return voxelSurface(
        [](int x, int y, int z) {
            if (y < -16 || y >= 8 || z < -2 || z >= 2) return false;
            const int side = x < 0 ? -1 - x : x; // cells 0.. from the middle outwards
            if (side < 4) return true;           // trunk
            if (side == 4) return y >= 4;        // the gap, bridged by the shoulders
            return side < 8;                     // arm
        },
        20, 0.25);
}

void addJoint(osgSkin::RestSkeleton& skeleton, const std::string& name, const std::string& parent,
              const glm::dvec3& centre) {
    skeleton.joints.push_back({name, parent.empty() ? -1 : skeleton.find(parent), centre, {}});
}

osgSkin::RestSkeleton hangingArmsSkeleton() {
    osgSkin::RestSkeleton skeleton;
    addJoint(skeleton, "hips", "", {0, -3, 0});
    addJoint(skeleton, "chest", "hips", {0, 1, 0});
    for (const double side : {-1.0, 1.0}) {
        const std::string prefix = side < 0 ? "right" : "left";
        addJoint(skeleton, prefix + "Arm", "chest", {1.6 * side, 1.4, 0});
        addJoint(skeleton, prefix + "Elbow", prefix + "Arm", {1.6 * side, -0.9, 0});
        addJoint(skeleton, prefix + "Palm", prefix + "Elbow", {1.6 * side, -3.2, 0});
        skeleton.joints.back().tip = glm::dvec3(1.6 * side, -4, 0);
    }
    return skeleton;
}

osgSkin::SkinMesh exploded(const osgSkin::SkinMesh& mesh) {
    osgSkin::SkinMesh result;
    result.faceSizes = mesh.faceSizes;
    for (const std::uint32_t v : mesh.faceVertices) {
        result.faceVertices.push_back(static_cast<std::uint32_t>(result.positions.size()));
        result.positions.push_back(mesh.positions[v]);
    }
    return result;
}

osgSkin::SkinMesh joined(const osgSkin::SkinMesh& a, const osgSkin::SkinMesh& b) {
    osgSkin::SkinMesh result = a;
    const auto offset = static_cast<std::uint32_t>(a.positions.size());
    result.positions.insert(result.positions.end(), b.positions.begin(), b.positions.end());
    result.faceSizes.insert(result.faceSizes.end(), b.faceSizes.begin(), b.faceSizes.end());
    for (const std::uint32_t v : b.faceVertices) result.faceVertices.push_back(offset + v);
    return result;
}

osgSkin::SkinMesh garment(const osgSkin::SkinMesh& body,
                          const std::function<bool(const glm::dvec3&)>& isCovered,
                          double distance) {
    std::vector<glm::dvec3> normals(body.positions.size(), glm::dvec3(0.0));
    std::vector<bool> isUsed(body.positions.size());
    const std::vector<std::uint32_t> corners = body.triangles();
    osgSkin::SkinMesh result;
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
        const std::array<std::uint32_t, 3> face = {corners[t], corners[t + 1], corners[t + 2]};
        const glm::dvec3& a = body.positions[face[0]];
        const glm::dvec3 n = glm::cross(body.positions[face[1]] - a, body.positions[face[2]] - a);
        for (const std::uint32_t v : face) normals[v] += n;
        if (!std::all_of(face.begin(), face.end(),
                         [&](std::uint32_t v) { return isCovered(body.positions[v]); }))
            continue;
        result.faceSizes.push_back(3);
        for (const std::uint32_t v : face) {
            isUsed[v] = true;
            result.faceVertices.push_back(v);
        }
    }
    std::vector<std::uint32_t> placed(body.positions.size());
    for (std::size_t v = 0; v < placed.size(); ++v) {
        placed[v] = static_cast<std::uint32_t>(result.positions.size());
        if (isUsed[v])
            result.positions.push_back(body.positions[v] + distance * glm::normalize(normals[v]));
    }
    for (std::uint32_t& v : result.faceVertices) v = placed[v];
    return result;
}

osgSkin::SkinMesh moved(osgSkin::SkinMesh mesh, const glm::dvec3& by, double scale) {
    for (glm::dvec3& p : mesh.positions) p = scale * p + by;
    return mesh;
}

osgSkin::SkinMesh sheet(std::uint32_t side) {
    osgSkin::SkinMesh mesh;
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

} // namespace shapes
