// SPDX-License-Identifier: MIT
#include "mesh/WeldedMesh.h"

#include "mesh/DisjointSets.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

namespace osgSkin {
namespace {

/// At most this many triangles of touching closed pieces share an edge. With more, nothing tells
/// which of them belong together.
constexpr std::ptrdiff_t kMaxTouching = 16;

/// A shell is flat if its volume, six times, is a smaller share of its area to the power of 3/2.
constexpr double kFlat = 1e-9;

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

/// Finds an earlier point within `tolerance` of a new one.
class PointFinder {
public:
    PointFinder(const glm::dvec3& origin, double tolerance)
        : _origin(origin), _tolerance(tolerance) {}

    /// The index of a point of `points` near p. If there is none, adds p as points.size(), and
    /// returns that.
    std::uint32_t findOrAdd(const glm::dvec3& p, const std::vector<glm::dvec3>& points) {
        const glm::dvec3 reach(_tolerance);
        const Cell low = cell(p - reach), high = cell(p + reach);
        for (std::int64_t x = low.x; x <= high.x; ++x)
            for (std::int64_t y = low.y; y <= high.y; ++y)
                for (std::int64_t z = low.z; z <= high.z; ++z) {
                    const auto [first, end] = _cells.equal_range({x, y, z});
                    for (auto found = first; found != end; ++found)
                        if (glm::distance(points[found->second], p) <= _tolerance)
                            return found->second;
                }
        const auto added = static_cast<std::uint32_t>(points.size());
        _cells.emplace(cell(p), added);
        return added;
    }

private:
    /// Cells are so much wider than the tolerance that few points are near others.
    static constexpr double kWidth = 16.0;

    Cell cell(const glm::dvec3& p) const {
        const glm::dvec3 q = (p - _origin) / (kWidth * _tolerance);
        return {std::llround(q.x), std::llround(q.y), std::llround(q.z)};
    }

    glm::dvec3 _origin;
    double _tolerance;
    std::unordered_multimap<Cell, std::uint32_t, CellHash> _cells;
};

/// A triangle's side between two welded vertices, the lower one first.
struct Side {
    std::uint32_t low, high;
    bool isForward; ///< the triangle goes from the lower to the higher
    std::size_t triangle;

    bool isAlong(const Side& other) const { return low == other.low && high == other.high; }
};

/// All sides of triangles, sorted by edge, then by triangle.
std::vector<Side> sidesOf(const std::vector<std::uint32_t>& corners,
                          const std::vector<std::uint32_t>& weldedOf) {
    std::vector<Side> sides;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = weldedOf[corners[i + k]],
                                to = weldedOf[corners[i + (k + 1) % 3]];
            if (from != to)
                sides.push_back({std::min(from, to), std::max(from, to), from < to, i / 3});
        }
    std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::pair(a.low, a.high) < std::pair(b.low, b.high);
    });
    return sides;
}

/// Joins the triangles on both sides of an edge. If several pieces touch there, the edge has more
/// than two triangles: each is joined with the one of the opposite direction that is nearest in the
/// file, since a piece's faces are usually consecutive.
/// \param first the first of the sides along one edge
/// \param end one past the last of them
/// \param isOpen is set for triangles that are joined with no other
void joinAcross(std::vector<Side>::const_iterator first, std::vector<Side>::const_iterator end,
                DisjointSets& pieces, std::vector<bool>& isOpen) {
    std::vector<Side> left(first, end);
    while (!left.empty()) {
        std::size_t a = 0, b = 0, nearest = std::numeric_limits<std::size_t>::max();
        for (std::size_t i = 0; i < left.size(); ++i)
            for (std::size_t j = i + 1; j < left.size(); ++j) {
                const std::size_t away = left[j].triangle - left[i].triangle;
                if (left[i].isForward == left[j].isForward || away >= nearest) continue;
                a = i;
                b = j;
                nearest = away;
            }
        if (b == 0) break;
        pieces.join(left[a].triangle, left[b].triangle);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(b));
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(a));
    }
    for (const Side& side : left) isOpen[side.triangle] = true;
}

/// Turns the triangles of shells with inverted winding, which enclose a negative volume. An open
/// shell's volume is taken about its centre.
void orientShells(WeldedMesh& mesh) {
    const std::vector<std::uint32_t>& shellOf = mesh.shellOf;
    const std::vector<glm::dvec3>& positions = mesh.positions;
    const std::size_t shells = mesh.shells;
    std::vector<glm::dvec3> centres(shells, glm::dvec3(0.0));
    std::vector<double> counts(shells, 0.0), volumes(shells, 0.0), areas(shells, 0.0);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (shellOf[v] == WeldedMesh::kNoShell) continue;
        centres[shellOf[v]] += positions[v];
        counts[shellOf[v]] += 1.0;
    }
    for (std::size_t shell = 0; shell < shells; ++shell) centres[shell] /= counts[shell];
    for (const auto& t : mesh.triangles) {
        const std::uint32_t shell = shellOf[t[0]];
        const glm::dvec3 a = positions[t[0]] - centres[shell];
        const glm::dvec3 b = positions[t[1]] - centres[shell];
        const glm::dvec3 c = positions[t[2]] - centres[shell];
        volumes[shell] += glm::dot(a, glm::cross(b, c));
        areas[shell] += glm::length(glm::cross(b - a, c - a));
    }
    for (auto& t : mesh.triangles) {
        const std::uint32_t shell = shellOf[t[0]];
        if (volumes[shell] < -kFlat * areas[shell] * std::sqrt(areas[shell])) std::swap(t[1], t[2]);
    }
}

} // namespace

std::vector<DirectedEdge> edgesOf(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    // Each vertex's edges side by side, and then sorted alone.
    std::vector<std::size_t> end; // of those of each vertex
    for (const auto& t : triangles)
        for (const std::uint32_t v : t) {
            if (v >= end.size()) end.resize(v + std::size_t(1), 0);
            end[v] += 2;
        }
    std::size_t all = 0;
    for (std::size_t& of : end) all = std::exchange(of, all) + all;
    std::vector<DirectedEdge> edges(all);
    const auto add = [&](std::uint32_t from, std::uint32_t to) { edges[end[from]++] = {from, to}; };
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            add(t[k], t[(k + 1) % 3]);
            add(t[(k + 1) % 3], t[k]);
        }
    const auto at = [&](std::size_t i) { return edges.begin() + static_cast<std::ptrdiff_t>(i); };
    for (std::size_t v = 0; v < end.size(); ++v) std::sort(at(v > 0 ? end[v - 1] : 0), at(end[v]));
    return edges;
}

void listNeighbours(std::size_t vertices, const std::vector<DirectedEdge>& edges,
                    std::vector<std::uint32_t>& firstNeighbour,
                    std::vector<std::uint32_t>& neighbours) {
    firstNeighbour.assign(vertices + 1, 0);
    neighbours.clear();
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (i > 0 && edges[i] == edges[i - 1]) continue;
        ++firstNeighbour[edges[i].first + 1];
        neighbours.push_back(edges[i].second);
    }
    for (std::size_t v = 0; v < vertices; ++v) firstNeighbour[v + 1] += firstNeighbour[v];
}

WeldedMesh::WeldedMesh(const SkinMesh& mesh, double same) : size(mesh.size()) {
    weld(mesh, std::max(same * size, std::numeric_limits<double>::min()));
    partClosedPieces(mesh);
    addTriangles(mesh);
    connect();
    findShells();
    orientShells(*this);
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

/// Gives each closed piece vertices of its own where it touches others.
void WeldedMesh::partClosedPieces(const SkinMesh& mesh) {
    const std::vector<std::uint32_t> corners = mesh.triangles();
    const std::vector<Side> sides = sidesOf(corners, weldedOf);
    bool touch = false; // more than two triangles share an edge
    for (std::size_t i = 0; i + 2 < sides.size() && !touch; ++i)
        touch = sides[i].isAlong(sides[i + 2]);
    if (!touch) return;
    const std::size_t triangleCount = corners.size() / 3;
    DisjointSets pieces(triangleCount);
    std::vector<bool> isOpen(triangleCount, false);
    for (auto first = sides.begin(); first != sides.end();) {
        const auto end = std::find_if(first, sides.end(),
                                      [&first](const Side& side) { return !side.isAlong(*first); });
        if (end - first <= kMaxTouching) joinAcross(first, end, pieces, isOpen);
        first = end;
    }
    constexpr std::size_t kNoTriangle = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> triangleAt(mesh.positions.size(), kNoTriangle);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        std::size_t& first = triangleAt[corners[i]];
        if (first == kNoTriangle) first = i / 3;
        pieces.join(first, i / 3);
    }
    std::vector<bool> isPieceOpen(triangleCount, false);
    for (std::size_t t = 0; t < triangleCount; ++t)
        if (isOpen[t]) isPieceOpen[pieces.find(t)] = true;
    // The first piece at a vertex keeps it; open pieces share theirs.
    std::map<std::pair<std::uint32_t, std::size_t>, std::uint32_t> ownCopies;
    std::vector<std::size_t> keeper(positions.size(), kNoTriangle);
    for (std::size_t v = 0; v < weldedOf.size(); ++v) {
        if (triangleAt[v] == kNoTriangle) continue;
        const std::size_t found = pieces.find(triangleAt[v]);
        const std::size_t piece = isPieceOpen[found] ? triangleCount : found;
        const std::uint32_t welded = weldedOf[v];
        if (keeper[welded] == kNoTriangle) keeper[welded] = piece;
        if (keeper[welded] == piece) continue;
        const auto [copy, isNew] = ownCopies.emplace(std::pair(welded, piece),
                                                     static_cast<std::uint32_t>(positions.size()));
        if (isNew) positions.push_back(glm::dvec3(positions[welded]));
        weldedOf[v] = copy->second;
    }
}

void WeldedMesh::addTriangles(const SkinMesh& mesh) {
    using Triangle = std::array<std::uint32_t, 3>;
    const std::vector<std::uint32_t> corners = mesh.triangles();
    std::vector<std::pair<Triangle, std::uint32_t>> sorted; // corners in order, number
    sorted.reserve(corners.size() / 3);
    const auto triangleAt = [&](std::size_t i) {
        return Triangle{weldedOf[corners[i]], weldedOf[corners[i + 1]], weldedOf[corners[i + 2]]};
    };
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        Triangle key = triangleAt(i);
        std::sort(key.begin(), key.end());
        if (key[0] == key[1] || key[1] == key[2]) continue;
        sorted.emplace_back(key, static_cast<std::uint32_t>(i / 3));
    }
    std::sort(sorted.begin(), sorted.end());
    const auto end = std::unique(sorted.begin(), sorted.end(),
                                 [](const auto& a, const auto& b) { return a.first == b.first; });
    std::sort(sorted.begin(), end,
              [](const auto& a, const auto& b) { return a.second < b.second; });
    triangles.reserve(std::size_t(end - sorted.begin()));
    for (auto each = sorted.begin(); each != end; ++each)
        triangles.push_back(triangleAt(3 * std::size_t(each->second)));
}

void WeldedMesh::connect() {
    const std::vector<DirectedEdge> edges = edgesOf(triangles);
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
            for (const std::uint32_t next : neighboursOf(v))
                if (shellOf[next] == kNoShell) {
                    shellOf[next] = shell;
                    open.push_back(next);
                }
        }
    }
}

void WeldedMesh::computeNormals() {
    normals.assign(positions.size(), glm::dvec3(0.0));
    for (const auto& t : triangles) {
        const glm::dvec3& a = positions[t[0]];
        const glm::dvec3 areaNormal = glm::cross(positions[t[1]] - a, positions[t[2]] - a);
        for (const std::uint32_t v : t) normals[v] += areaNormal;
    }
    for (glm::dvec3& normal : normals) {
        const double length = glm::length(normal);
        if (length > 0.0) normal /= length;
    }
}

} // namespace osgSkin
