// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/SolidGrid.h"

#include "mesh/DisjointSets.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace osgSkin::fit {
namespace {

/// Borders nearer to each other than this fraction of the mesh's size are a seam.
constexpr double kSeam = 4e-4;

using Triangle = std::array<std::uint32_t, 3>;

/// An edge, from its lower vertex to its higher one, as a side of a triangle.
struct Side {
    std::uint32_t low, high;
    std::uint32_t triangle;
    bool forward; ///< the triangle's side runs from low to high
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

/// The triangles with vertices of borders joined if they coincide: borders may come from an
/// exporter's rounding, or from parts that were cut apart.
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

/// Gives triangles the same winding across edges that two of them share.
/// \return the index of each triangle's piece
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

/// The triangles, and fans about their middles that cover the holes.
ClosedShell closed(const WeldedMesh& mesh, const std::vector<Triangle>& triangles) {
    ClosedShell shell;
    for (const Triangle& t : triangles)
        shell.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
    // For each vertex of a border the next ones along the edges of covering faces, repeated if
    // several faces need that edge.
    std::map<std::uint32_t, std::vector<std::uint32_t>> border, around;
    const std::vector<Side> sides = sidesOf(triangles);
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
            middle += mesh.positions[v] / static_cast<double>(loop.size());
        for (const std::uint32_t v : loop)
            for (const std::uint32_t next : border[v])
                shell.push_back({mesh.positions[v], mesh.positions[next], middle});
    }
    return shell;
}

/// Empty cubes around everything, so that the outside is connected.
constexpr int kMargin = 4;

/// Half the widest gap of an enclosing shell, and half the widest between joined pieces, in cubes.
constexpr int kGap = 3;
constexpr int kReach = 7;

/// Slits between joined shells are filled where they are up to this many cubes wider than at the
/// narrowest.
constexpr int kSlit = 2;

/// Separate shells smaller than this fraction of all are dropped.
constexpr double kCrumb = 0.002;

/// Twice the area of (a, b, p) in the plane of x and z; exactly the negative for (b, a, p), so that
/// a point is in exactly one of two triangles with a common edge.
double side(const glm::dvec3& a, const glm::dvec3& b, double x, double z) {
    const bool swapped = std::tie(b.x, b.z) < std::tie(a.x, a.z);
    const glm::dvec3 &from = swapped ? b : a, &to = swapped ? a : b;
    double value = (to.x - from.x) * (z - from.z) - (to.z - from.z) * (x - from.x);
    if (value == 0.0) value = std::numeric_limits<double>::min();
    return swapped ? -value : value;
}

/// Where a line along y enters or leaves a shell.
struct Crossing {
    std::size_t column;
    double y;
    int way;
    bool operator<(const Crossing& o) const {
        return std::tie(column, y, way) < std::tie(o.column, o.y, o.way);
    }
};

/// Where the growing fronts of two shells met, after so many steps, in two neighbouring cubes.
struct Meeting {
    int steps;
    std::size_t a, b;
};

/// By pairs of shells; each in the order of steps.
using Meetings = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Meeting>>;

struct Pair {
    int steps;
    std::size_t width; ///< number of meetings after nearly as few steps
    std::pair<std::uint32_t, std::uint32_t> shells;
};

/// The pairs of shells, those with the shortest paths first, then those with the widest fronts.
std::vector<Pair> nearestFirst(const Meetings& meetings) {
    std::vector<Pair> pairs;
    for (const auto& [shells, all] : meetings) {
        const int least = all.front().steps;
        const auto width = std::count_if(
            all.begin(), all.end(), [least](const Meeting& m) { return m.steps <= least + kSlit; });
        pairs.push_back({least, static_cast<std::size_t>(width), shells});
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
        return a.steps != b.steps ? a.steps < b.steps : a.width > b.width;
    });
    return pairs;
}

} // namespace

std::vector<ClosedShell> closedShells(const WeldedMesh& mesh, const std::vector<Triangle>& given) {
    std::vector<Triangle> triangles = stitched(mesh, given);
    std::uint32_t pieces = 0;
    const std::vector<std::uint32_t> pieceOf = windAlike(triangles, pieces);
    std::vector<std::vector<Triangle>> sorted(pieces);
    for (std::size_t t = 0; t < triangles.size(); ++t) sorted[pieceOf[t]].push_back(triangles[t]);
    std::vector<ClosedShell> shells;
    shells.reserve(pieces);
    for (const std::vector<Triangle>& piece : sorted) shells.push_back(closed(mesh, piece));
    return shells;
}

SolidGrid::SolidGrid(const glm::dvec3& low, const glm::dvec3& high, int cells) {
    const glm::dvec3 extent = high - low;
    _edge = std::max({extent.x, extent.y, extent.z}) / cells;
    // Avoids round numbers, on which edges of artificial figures lie.
    _origin = low - _edge * (double(kMargin) + glm::dvec3(0.4142, 0.4472, 0.4321));
    _size = glm::ivec3(glm::ceil(extent / _edge)) + 2 * kMargin + 1;
    _solid.assign(index({0, 0, _size.z}), 0);
    _shellOf.assign(_solid.size(), 0);
}

std::size_t SolidGrid::count() const {
    return static_cast<std::size_t>(std::count(_solid.begin(), _solid.end(), 1));
}

glm::ivec3 SolidGrid::cellAt(std::size_t at) const {
    const auto x = static_cast<std::size_t>(_size.x), y = static_cast<std::size_t>(_size.y);
    return {static_cast<int>(at % x), static_cast<int>(at / x % y), static_cast<int>(at / x / y)};
}

bool SolidGrid::contains(const glm::ivec3& c) const {
    return c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < _size.x && c.y < _size.y && c.z < _size.z;
}

template <typename Use>
void SolidGrid::forEachNeighbour(std::size_t at, const Use& use) const {
    const glm::ivec3 cell = cellAt(at);
    for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
            glm::ivec3 next = cell;
            next[axis] += step;
            if (contains(next)) use(index(next));
        }
}

void SolidGrid::add(const ClosedShell& shell) {
    ++_shells;
    std::vector<Crossing> crossings;
    for (const auto& given : shell) {
        // In cubes; their centres have integer coordinates.
        std::array<glm::dvec3, 3> t;
        for (std::size_t k = 0; k < 3; ++k) t[k] = (given[k] - _origin) / _edge - 0.5;
        const auto [lowX, highX] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [lowZ, highZ] = std::minmax({t[0].z, t[1].z, t[2].z});
        for (int z = std::max(0, static_cast<int>(std::ceil(lowZ)));
             z <= std::min(_size.z - 1, static_cast<int>(std::floor(highZ))); ++z)
            for (int x = std::max(0, static_cast<int>(std::ceil(lowX)));
                 x <= std::min(_size.x - 1, static_cast<int>(std::floor(highX))); ++x) {
                const double a = side(t[1], t[2], x, z), b = side(t[2], t[0], x, z);
                const double c = side(t[0], t[1], x, z), sum = a + b + c;
                if ((a > 0.0) != (b > 0.0) || (b > 0.0) != (c > 0.0) || sum == 0.0) continue;
                crossings.push_back({index({x, 0, z}), (a * t[0].y + b * t[1].y + c * t[2].y) / sum,
                                     sum > 0.0 ? 1 : -1});
            }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i < crossings.size();) {
        std::size_t end = i;
        int winding = 0;
        for (; end < crossings.size() && crossings[end].column == crossings[i].column; ++end)
            winding += crossings[end].way;
        if (winding != 0) { // by rounding only
            i = end;
            continue;
        }
        const glm::ivec3 bottom = cellAt(crossings[i].column);
        for (; i < end; ++i) {
            winding += crossings[i].way;
            if (winding == 0 || i + 1 == end) continue;
            const int from = std::max(0, static_cast<int>(std::ceil(crossings[i].y)));
            const int to = std::min(_size.y - 1, static_cast<int>(std::floor(crossings[i + 1].y)));
            for (int y = from; y <= to; ++y) {
                const std::size_t at = index({bottom.x, y, bottom.z});
                if (!_solid[at]) _shellOf[at] = _shells;
                _solid[at] = 1;
            }
        }
    }
}

/// Steps from the solid, at most `most`.
std::vector<std::uint8_t> SolidGrid::distances(int most) const {
    std::vector<std::uint8_t> result(_solid.size(), static_cast<std::uint8_t>(most));
    std::vector<std::size_t> front, next;
    for (std::size_t i = 0; i < _solid.size(); ++i)
        if (_solid[i]) {
            result[i] = 0;
            front.push_back(i);
        }
    for (int step = 1; step < most; ++step) {
        next.clear();
        for (const std::size_t i : front)
            forEachNeighbour(i, [&](std::size_t n) {
                if (result[n] <= step) return;
                result[n] = static_cast<std::uint8_t>(step);
                next.push_back(n);
            });
        front.swap(next);
    }
    return result;
}

void SolidGrid::fillPockets() {
    const std::vector<std::uint8_t> away = distances(kGap + 1);
    std::vector<std::size_t> open, pocket;
    for (int gap = 0; gap <= kGap; ++gap) {
        std::vector<bool> outside(_solid.size(), false);
        outside[0] = true; // the margin
        open.assign(1, 0);
        while (!open.empty()) {
            const std::size_t at = open.back();
            open.pop_back();
            forEachNeighbour(at, [&](std::size_t n) {
                if (outside[n] || away[n] <= gap) return;
                outside[n] = true;
                open.push_back(n);
            });
        }
        pocket.clear();
        for (std::size_t i = 0; i < _solid.size(); ++i)
            if (away[i] > gap && !outside[i] && !_solid[i]) pocket.push_back(i);
        for (int grown = 0; grown <= gap; ++grown) {
            open.clear();
            for (const std::size_t i : pocket) {
                _solid[i] = 1;
                forEachNeighbour(i, [&](std::size_t n) {
                    if (!_solid[n]) open.push_back(n);
                });
            }
            pocket.swap(open);
        }
    }
}

void SolidGrid::addBall(std::size_t at, int radius) {
    const glm::ivec3 middle = cellAt(at);
    for (int z = -radius; z <= radius; ++z)
        for (int y = -radius; y <= radius; ++y)
            for (int x = -radius; x <= radius; ++x) {
                const glm::ivec3 cell = middle + glm::ivec3(x, y, z);
                if (x * x + y * y + z * z <= radius * radius && contains(cell))
                    _solid[index(cell)] = 1;
            }
}

/// Lets all shells grow into solid cubes that are of none, which were pockets.
/// \return the cubes of all shells
std::vector<std::size_t> SolidGrid::fillShells(std::vector<std::uint32_t>& shell) const {
    std::vector<std::size_t> front, next;
    for (std::size_t i = 0; i < shell.size(); ++i)
        if (shell[i] != 0) front.push_back(i);
    for (std::vector<std::size_t> open = front; !open.empty(); open.swap(next)) {
        next.clear();
        for (const std::size_t i : open)
            forEachNeighbour(i, [&](std::size_t n) {
                if (!_solid[n] || shell[n] != 0) return;
                shell[n] = shell[i];
                next.push_back(n);
                front.push_back(n);
            });
    }
    return front;
}

/// Empties the cubes of small shells that nothing joins to the largest one.
///
/// \param shell of each cube, one number for all shells that are joined; 0: none
/// \param sizes of the shells, in cubes
void SolidGrid::dropCrumbs(const std::vector<std::uint32_t>& shell,
                           const std::vector<std::size_t>& sizes) {
    const std::size_t largest =
        static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    const double all =
        static_cast<double>(std::accumulate(sizes.begin(), sizes.end(), std::size_t(0)));
    for (std::size_t i = 0; i < _solid.size(); ++i)
        if (shell[i] != 0 && shell[i] != largest &&
            static_cast<double>(sizes[shell[i]]) < kCrumb * all)
            _solid[i] = 0;
}

int SolidGrid::join() {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    // All shells grow at once. Where two fronts meet, there is a path between them.
    std::vector<std::uint32_t> shell = _shellOf;
    std::vector<std::size_t> from(_solid.size(), kNone), front = fillShells(shell), next;
    std::vector<std::uint32_t> own = shell;
    Meetings meetings;
    for (int step = 0; step <= kReach; ++step) {
        next.clear();
        for (const std::size_t i : front)
            forEachNeighbour(i, [&](std::size_t n) {
                if (shell[n] == 0) {
                    if (step == 0) return; // only finds shells that touch
                    shell[n] = shell[i];
                    from[n] = i;
                    next.push_back(n);
                } else if (shell[n] != shell[i]) {
                    meetings[std::minmax(shell[i], shell[n])].push_back({step, i, n});
                }
            });
        if (step > 0) front.swap(next);
    }
    DisjointSets joined(_shells + 1);
    int bridged = 0;
    for (const Pair& pair : nearestFirst(meetings)) {
        if (joined.find(pair.shells.first) == joined.find(pair.shells.second)) continue;
        joined.join(pair.shells.first, pair.shells.second);
        bridged += pair.steps > 0;
        for (const Meeting& meeting : meetings[pair.shells])
            for (std::size_t at : {meeting.a, meeting.b})
                for (; meeting.steps <= pair.steps + kSlit && at != kNone; at = from[at])
                    addBall(at, 1);
    }
    std::vector<std::size_t> sizes(_shells + 1, 0);
    for (std::uint32_t& of : own) {
        of = static_cast<std::uint32_t>(joined.find(of));
        if (of != 0) ++sizes[of];
    }
    dropCrumbs(own, sizes);
    return bridged;
}

void SolidGrid::thickenTouches() {
    const glm::ivec3 unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    bool changed = true;
    for (int pass = 0; pass < 20 && changed; ++pass) {
        changed = false;
        const auto fill = [&](const glm::ivec3& c) {
            _solid[index(c)] = 1;
            changed = true;
        };
        for (int z = 0; z + 1 < _size.z; ++z)
            for (int y = 0; y + 1 < _size.y; ++y)
                for (int x = 0; x + 1 < _size.x; ++x) {
                    const glm::ivec3 c(x, y, z);
                    for (int axis = 0; axis < 3; ++axis) {
                        const glm::ivec3 u = unit[(axis + 1) % 3], v = unit[(axis + 2) % 3];
                        const bool a = solid(c), b = solid(c + u);
                        if (a == b || solid(c + v) != b || solid(c + u + v) != a) continue;
                        fill(a ? c + u : c);
                    }
                    for (int corner = 0; corner < 4; ++corner) {
                        const glm::ivec3 o(corner & 1, corner >> 1, 0);
                        const glm::ivec3 near = c + o, far = c + glm::ivec3(1) - o;
                        const bool a = solid(near);
                        if (solid(far) != a) continue;
                        int same = 0;
                        for (int n = 0; n < 8; ++n)
                            same += solid(c + glm::ivec3(n & 1, n >> 1 & 1, n >> 2)) == a;
                        if (same != 2) continue;
                        fill(a ? near + glm::ivec3(corner & 1 ? -1 : 1, 0, 0) : near);
                    }
                }
    }
}

} // namespace osgSkin::fit
