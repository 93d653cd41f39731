// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/Shells.h"

#include "fit/solid/ClosedShells.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <iomanip>
#include <limits>
#include <numeric>
#include <sstream>
#include <vector>

namespace osgSkin {
namespace {

/// Along the longest side: a person's wrist is four wide.
constexpr int kCells = 128;

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-low};
    double area = 0.0;
    std::size_t triangles = 0;

    void add(const WeldedMesh& mesh, const std::array<std::uint32_t, 3>& t) {
        for (const std::uint32_t v : t) {
            low = glm::min(low, mesh.positions[v]);
            high = glm::max(high, mesh.positions[v]);
        }
        area += glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                       mesh.positions[t[2]] - mesh.positions[t[0]]));
        ++triangles;
    }
};

Box wholeBox(const WeldedMesh& mesh) {
    Box box;
    for (const auto& t : mesh.triangles) box.add(mesh, t);
    return box;
}

std::vector<Box> shellBoxes(const WeldedMesh& mesh) {
    std::vector<Box> boxes(mesh.shells);
    for (const auto& t : mesh.triangles) boxes[mesh.shellOf[t[0]]].add(mesh, t);
    return boxes;
}

double longest(const Box& box) {
    const glm::dvec3 extent = box.high - box.low;
    return std::max({extent.x, extent.y, extent.z});
}

} // namespace

bool isOneSkin(const WeldedMesh& mesh) {
    if (mesh.shells > 1) return false;
    std::vector<std::array<std::uint32_t, 2>> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 2; i < edges.size(); ++i)
        if (edges[i] == edges[i - 2]) return false;
    return true;
}

double largestShellShare(const WeldedMesh& mesh) {
    if (mesh.triangles.empty()) return 1.0;
    const std::vector<Box> boxes = shellBoxes(mesh);
    const auto largest = std::max_element(
        boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.area < b.area; });
    return longest(*largest) / longest(wholeBox(mesh));
}

fit::SolidGrid filledByAll(const WeldedMesh& mesh) {
    const Box whole = wholeBox(mesh);
    fit::SolidGrid grid(whole.low, whole.high, kCells);
    for (const fit::ClosedShell& shell : fit::closedShells(mesh, mesh.triangles)) grid.add(shell);
    grid.fillPockets();
    return grid;
}

std::string describeShells(const WeldedMesh& mesh) {
    const std::vector<Box> boxes = shellBoxes(mesh);
    std::vector<std::size_t> order(boxes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return boxes[a].area > boxes[b].area; });
    constexpr std::size_t kNamed = 4;
    std::ostringstream out;
    out << "measured the union of " << boxes.size() << " shells:";
    for (std::size_t i = 0; i < std::min(kNamed, order.size()); ++i) {
        const Box& box = boxes[order[i]];
        const glm::dvec3 middle = 0.5 * (box.low + box.high), extent = box.high - box.low;
        out << (i > 0 ? ", " : " ") << "one of " << box.triangles << " triangles about ("
            << std::setprecision(3) << middle.x << ", " << middle.y << ", " << middle.z << "), "
            << extent.x << " x " << extent.y << " x " << extent.z << " large";
    }
    if (order.size() > kNamed) out << ", and " << order.size() - kNamed << " smaller ones";
    return out.str();
}

} // namespace osgSkin
