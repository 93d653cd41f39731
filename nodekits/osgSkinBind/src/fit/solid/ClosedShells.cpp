// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/solid/ClosedShells.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace osgSkin::fit {
namespace {

/// Borders nearer than this fraction of the mesh's size are a seam.
constexpr double kSeam = 4e-4;

using Triangle = std::array<std::uint32_t, 3>;

/// An edge from its lower vertex to its higher one, with the side of a triangle that it is.
struct Side {
    std::uint32_t low, high;
    std::uint32_t triangle;
    bool forward; ///< the triangle runs from low to high
    bool operator<(const Side& o) const {
        return std::tie(low, high, triangle) < std::tie(o.low, o.high, o.triangle);
    }
    bool sameEdge(const Side& o) const { return low == o.low && high == o.high; }
};

std::vector<Side> sidesOf(const std::vector<Triangle>& triangles) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    std::sort(sides.begin(), sides.end());
    return sides;
}

/// Calls use(begin, end) for the sides of each edge.
template <typename Use>
void forEachEdge(const std::vector<Side>& sides, const Use& use) {
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].sameEdge(sides[i])) ++end;
        use(i, end);
        i = end;
    }
}

/// The triangles with vertices of borders joined where they lie together: an exporter's rounding,
/// or parts that were cut from one another.
std::vector<Triangle> stitched(const WeldedMesh& mesh, const std::vector<Triangle>& triangles) {
    std::vector<bool> onBorder(mesh.vertexCount(), false);
    const std::vector<Side> sides = sidesOf(triangles);
    forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 1) onBorder[sides[begin].low] = onBorder[sides[begin].high] = true;
    });
    std::vector<std::uint32_t> of(mesh.vertexCount());
    std::iota(of.begin(), of.end(), 0u);
    const double tolerance = kSeam * mesh.size;
    using Cell = std::tuple<long long, long long, long long>;
    std::map<Cell, std::vector<std::uint32_t>> cells;
    for (std::uint32_t v = 0; v < of.size(); ++v) {
        if (!onBorder[v]) continue;
        const glm::dvec3 q = (mesh.positions[v] - mesh.positions.front()) / tolerance;
        const long long x = std::llround(q.x), y = std::llround(q.y), z = std::llround(q.z);
        for (int n = 0; n < 27 && of[v] == v; ++n) {
            const auto near = cells.find({x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1});
            if (near == cells.end()) continue;
            for (const std::uint32_t other : near->second)
                if (glm::distance(mesh.positions[other], mesh.positions[v]) <= tolerance) {
                    of[v] = other;
                    break;
                }
        }
        if (of[v] == v) cells[{x, y, z}].push_back(v);
    }
    std::vector<Triangle> result;
    for (const auto& t : triangles) {
        const Triangle joined{of[t[0]], of[t[1]], of[t[2]]};
        if (joined[0] != joined[1] && joined[1] != joined[2] && joined[2] != joined[0])
            result.push_back(joined);
    }
    return result;
}

/// Winds triangles alike across the edges that two of them share.
///
/// \return the piece that each is of
std::vector<std::uint32_t> windAlike(std::vector<Triangle>& triangles, std::uint32_t& pieces) {
    struct Link {
        std::uint32_t triangle;
        bool turned;
    };
    std::vector<std::vector<Link>> links(triangles.size());
    const std::vector<Side> sides = sidesOf(triangles);
    forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
        if (end - begin != 2) return;
        const Side &a = sides[begin], &b = sides[begin + 1];
        const bool turned = a.forward == b.forward;
        links[a.triangle].push_back({b.triangle, turned});
        links[b.triangle].push_back({a.triangle, turned});
    });
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> pieceOf(triangles.size(), kNone);
    std::vector<bool> turned(triangles.size(), false);
    std::vector<std::uint32_t> open;
    for (std::uint32_t start = 0; start < triangles.size(); ++start) {
        if (pieceOf[start] != kNone) continue;
        pieceOf[start] = pieces;
        open.push_back(start);
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            for (const Link& link : links[t]) {
                if (pieceOf[link.triangle] != kNone) continue;
                pieceOf[link.triangle] = pieces;
                turned[link.triangle] = turned[t] != link.turned;
                open.push_back(link.triangle);
            }
        }
        ++pieces;
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (turned[t]) std::swap(triangles[t][1], triangles[t][2]);
    return pieceOf;
}

class Fans {
public:
    Fans(const WeldedMesh& mesh, const std::vector<Triangle>& triangles)
        : _mesh(mesh), _triangles(triangles) {}

    ClosedShell close() const {
        ClosedShell shell;
        for (const Triangle& t : _triangles)
            shell.push_back({_mesh.positions[t[0]], _mesh.positions[t[1]], _mesh.positions[t[2]]});
        // From each vertex of a border to those that a covering face runs to, as often as it does.
        std::map<std::uint32_t, std::vector<std::uint32_t>> border, around;
        const std::vector<Side> sides = sidesOf(_triangles);
        forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
            int sum = 0;
            for (std::size_t i = begin; i < end; ++i) sum += sides[i].forward ? 1 : -1;
            if (sum == 0) return;
            const std::uint32_t low = sides[begin].low, high = sides[begin].high;
            around[low].push_back(high);
            around[high].push_back(low);
            for (; sum > 0; --sum) border[high].push_back(low);
            for (; sum < 0; ++sum) border[low].push_back(high);
        });
        std::map<std::uint32_t, bool> known;
        for (const auto& [start, unused] : around) {
            if (known[start]) continue;
            std::vector<std::uint32_t> loop{start};
            known[start] = true;
            for (std::size_t i = 0; i < loop.size(); ++i)
                for (const std::uint32_t next : around[loop[i]])
                    if (!known[next]) {
                        known[next] = true;
                        loop.push_back(next);
                    }
            glm::dvec3 middle(0.0);
            for (const std::uint32_t v : loop)
                middle += _mesh.positions[v] / static_cast<double>(loop.size());
            for (const std::uint32_t v : loop)
                for (const std::uint32_t next : border[v])
                    shell.push_back({_mesh.positions[v], _mesh.positions[next], middle});
        }
        return shell;
    }

private:
    const WeldedMesh& _mesh;
    const std::vector<Triangle>& _triangles;
};

} // namespace

std::vector<ClosedShell> closedShells(const WeldedMesh& mesh, const std::vector<Triangle>& given) {
    std::vector<Triangle> triangles = stitched(mesh, given);
    std::uint32_t pieces = 0;
    const std::vector<std::uint32_t> pieceOf = windAlike(triangles, pieces);
    std::vector<std::vector<Triangle>> sorted(pieces);
    for (std::size_t t = 0; t < triangles.size(); ++t) sorted[pieceOf[t]].push_back(triangles[t]);
    std::vector<ClosedShell> shells;
    shells.reserve(pieces);
    for (const std::vector<Triangle>& piece : sorted) shells.push_back(Fans(mesh, piece).close());
    return shells;
}

} // namespace osgSkin::fit
