// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/WeldedMesh.h"

#include "mesh/Neighbours.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

namespace osgSkin {
namespace {

struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell& o) const { return x == o.x && y == o.y && z == o.z; }
};

struct CellHash {
    std::size_t operator()(const Cell& c) const {
        std::uint64_t h = static_cast<std::uint64_t>(c.x) * 0x9e3779b97f4a7c15ull;
        h = (h ^ (h >> 29)) + static_cast<std::uint64_t>(c.y) * 0xbf58476d1ce4e5b9ull;
        h = (h ^ (h >> 31)) + static_cast<std::uint64_t>(c.z) * 0x94d049bb133111ebull;
        return static_cast<std::size_t>(h ^ (h >> 30));
    }
};

/// Finds the earlier point within `tolerance` of a new one. Cells are as wide as the tolerance, so
/// that the 27 around a point hold all candidates.
class PointFinder {
public:
    PointFinder(const glm::dvec3& origin, double tolerance)
        : _origin(origin), _tolerance(tolerance) {}

    /// Index of a point of `points` near p; points.size() where there is none, and p is then known.
    std::uint32_t findOrAdd(const glm::dvec3& p, const std::vector<glm::dvec3>& points) {
        const Cell at = cell(p);
        for (std::int64_t dx = -1; dx <= 1; ++dx)
            for (std::int64_t dy = -1; dy <= 1; ++dy)
                for (std::int64_t dz = -1; dz <= 1; ++dz) {
                    const auto found = _cells.find({at.x + dx, at.y + dy, at.z + dz});
                    if (found != _cells.end() &&
                        glm::distance(points[found->second], p) <= _tolerance)
                        return found->second;
                }
        const auto added = static_cast<std::uint32_t>(points.size());
        _cells.emplace(at, added);
        return added;
    }

private:
    Cell cell(const glm::dvec3& p) const {
        const glm::dvec3 q = (p - _origin) / _tolerance;
        return {std::llround(q.x), std::llround(q.y), std::llround(q.z)};
    }

    glm::dvec3 _origin;
    double _tolerance;
    std::unordered_map<Cell, std::uint32_t, CellHash> _cells;
};

} // namespace

WeldedMesh::WeldedMesh(const SkinMesh& mesh, double same) : size(mesh.size()) {
    weld(mesh, std::max(same * size, std::numeric_limits<double>::min()));
    addTriangles(mesh);
    connect();
    findShells();
    computeNormals();
}

void WeldedMesh::weld(const SkinMesh& mesh, double tolerance) {
    PointFinder finder(mesh.positions.front(), tolerance);
    weldedOf.reserve(mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions) {
        const std::uint32_t welded = finder.findOrAdd(p, positions);
        if (welded == positions.size()) positions.push_back(p);
        weldedOf.push_back(welded);
    }
}

void WeldedMesh::addTriangles(const SkinMesh& mesh) {
    std::set<std::array<std::uint32_t, 3>> known;
    const std::vector<std::uint32_t> corners = mesh.triangles();
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        const std::array<std::uint32_t, 3> triangle = {
            weldedOf[corners[i]], weldedOf[corners[i + 1]], weldedOf[corners[i + 2]]};
        std::array<std::uint32_t, 3> key = triangle;
        std::sort(key.begin(), key.end());
        if (key[0] == key[1] || key[1] == key[2]) continue;
        if (known.insert(key).second) triangles.push_back(triangle);
    }
}

void WeldedMesh::connect() {
    std::vector<DirectedEdge> edges; // in both directions, once for each triangle
    edges.reserve(6 * triangles.size());
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            edges.emplace_back(t[k], t[(k + 1) % 3]);
            edges.emplace_back(t[(k + 1) % 3], t[k]);
        }
    std::sort(edges.begin(), edges.end());
    listNeighbours(positions.size(), edges, firstNeighbour, neighbours);
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i;
        while (end < edges.size() && edges[end] == edges[i]) ++end;
        if (end - i == 1 && edges[i].first < edges[i].second) ++openEdges;
        i = end;
    }
}

void WeldedMesh::findShells() {
    shellOf.assign(positions.size(), kNoShell);
    std::vector<std::uint32_t> open;
    for (std::uint32_t start = 0; start < positions.size(); ++start) {
        if (shellOf[start] != kNoShell || firstNeighbour[start] == firstNeighbour[start + 1])
            continue;
        const auto shell = static_cast<std::uint32_t>(shells++);
        shellOf[start] = shell;
        open.push_back(start);
        while (!open.empty()) {
            const std::uint32_t v = open.back();
            open.pop_back();
            for (std::uint32_t i = firstNeighbour[v]; i < firstNeighbour[v + 1]; ++i)
                if (shellOf[neighbours[i]] == kNoShell) {
                    shellOf[neighbours[i]] = shell;
                    open.push_back(neighbours[i]);
                }
        }
    }
}

void WeldedMesh::computeNormals() {
    normals.assign(positions.size(), glm::dvec3(0.0));
    std::vector<double> shellVolume(shells, 0.0);
    const glm::dvec3 origin = positions.front(); // keeps the volumes' digits far from the origin
    for (const auto& t : triangles) {
        const glm::dvec3 a = positions[t[0]] - origin;
        const glm::dvec3 b = positions[t[1]] - origin;
        const glm::dvec3 c = positions[t[2]] - origin;
        const glm::dvec3 areaNormal = glm::cross(b - a, c - a);
        for (const std::uint32_t v : t) normals[v] += areaNormal;
        shellVolume[shellOf[t[0]]] += glm::dot(a, glm::cross(b, c));
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const double length = glm::length(normals[v]);
        if (!(length > 0.0)) continue;
        // A shell that is wound inside out encloses a negative volume.
        normals[v] /= shellVolume[shellOf[v]] < 0.0 ? -length : length;
    }
}

} // namespace osgSkin
