// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/solid/SolidGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace osgSkin::fit {
namespace {

/// Empty cubes around everything, so that the outside is one.
constexpr int kMargin = 4;

/// Half the widest gap that encloses, and half the widest that pieces are joined over, in cubes.
constexpr int kGap = 3;
constexpr int kReach = 7;

/// Slits between joined shells are filled to as many cubes more than they are wide where narrowest.
constexpr int kSlit = 2;

/// Shells smaller than this fraction of all are left out where they are near nothing.
constexpr double kCrumb = 0.002;

/// Twice the area of (a, b, p) in the plane of x and z; exactly opposite for (b, a, p), so that a
/// point is in one of two triangles with a common edge.
double side(const glm::dvec3& a, const glm::dvec3& b, double x, double z) {
    const bool swapped = std::tie(b.x, b.z) < std::tie(a.x, a.z);
    const glm::dvec3 &from = swapped ? b : a, &to = swapped ? a : b;
    double value = (to.x - from.x) * (z - from.z) - (to.z - from.z) * (x - from.x);
    if (value == 0.0) value = std::numeric_limits<double>::min();
    return swapped ? -value : value;
}

/// Where a line along y meets a shell, and whether it comes out there.
struct Crossing {
    std::size_t column;
    double y;
    int way;
    bool operator<(const Crossing& o) const {
        return std::tie(column, y, way) < std::tie(o.column, o.y, o.way);
    }
};

} // namespace

SolidGrid::SolidGrid(const glm::dvec3& low, const glm::dvec3& high, int cells) {
    const glm::dvec3 extent = high - low;
    _edge = std::max({extent.x, extent.y, extent.z}) / cells;
    // Off round numbers: the edges of made-up figures lie on those.
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
        // In cubes, whole numbers at their centres.
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
        if (winding != 0) { // cannot be, but for rounding
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

/// Steps from the solid, up to `most`, which also stands for all that is farther.
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

int SolidGrid::join() {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    // All shells grow at once, first into pockets; where two fronts meet is a way between them.
    std::vector<std::uint32_t> shell = _shellOf;
    std::vector<std::size_t> from(_solid.size(), kNone), front, next;
    std::vector<std::size_t> sizes(_shells + 1, 0);
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
    for (const std::size_t i : front) ++sizes[shell[i]];
    const std::vector<std::uint32_t> own = shell;
    struct Meeting {
        int steps;
        std::size_t a, b;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Meeting>> meetings;
    for (int step = 0; step <= kReach; ++step) {
        next.clear();
        for (const std::size_t i : front)
            forEachNeighbour(i, [&](std::size_t n) {
                if (shell[n] == 0) {
                    if (step == 0) return; // only looks where shells touch
                    shell[n] = shell[i];
                    from[n] = i;
                    next.push_back(n);
                } else if (shell[n] != shell[i]) {
                    meetings[std::minmax(shell[i], shell[n])].push_back({step, i, n});
                }
            });
        if (step > 0) front.swap(next);
    }
    struct Pair {
        int steps;
        std::size_t width; ///< meetings, of near as many steps
        std::pair<std::uint32_t, std::uint32_t> shells;
    };
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
    std::vector<std::uint32_t> set(sizes.size());
    std::iota(set.begin(), set.end(), 0u);
    const auto root = [&set](std::uint32_t p) {
        while (set[p] != p) p = set[p] = set[set[p]];
        return p;
    };
    int bridged = 0;
    for (const Pair& pair : pairs) {
        const std::uint32_t a = root(pair.shells.first), b = root(pair.shells.second);
        if (a == b) continue;
        set[a] = b;
        sizes[b] += sizes[a];
        bridged += pair.steps > 0;
        for (const Meeting& meeting : meetings[pair.shells])
            for (std::size_t at : {meeting.a, meeting.b})
                for (; meeting.steps <= pair.steps + kSlit && at != kNone; at = from[at])
                    addBall(at, 1);
    }
    std::uint32_t largest =
        root(own[static_cast<std::size_t>(std::max_element(own.begin(), own.end()) - own.begin())]);
    std::size_t all = 0;
    for (std::uint32_t p = 1; p < sizes.size(); ++p) {
        if (root(p) != p) continue;
        all += sizes[p];
        if (sizes[p] > sizes[largest]) largest = p;
    }
    for (std::size_t i = 0; i < _solid.size(); ++i) {
        if (own[i] == 0) continue;
        const std::uint32_t p = root(own[i]);
        if (p != largest && static_cast<double>(sizes[p]) < kCrumb * static_cast<double>(all))
            _solid[i] = 0;
    }
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
