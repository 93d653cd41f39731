// SPDX-License-Identifier: GPL-3.0-or-later
#include "Patches.h"

#include <array>
#include <map>
#include <numeric>
#include <set>

namespace {

/// Disjoint sets of numbers.
class Sets {
public:
    explicit Sets(std::size_t count) : _above(count) {
        std::iota(_above.begin(), _above.end(), std::size_t{0});
    }
    std::size_t find(std::size_t i) {
        while (_above[i] != i) i = _above[i] = _above[_above[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) { _above[find(a)] = find(b); }

private:
    std::vector<std::size_t> _above;
};

} // namespace

std::size_t severedPatches(const osgSkin::SkinMesh& mesh,
                           const std::vector<std::uint32_t>& regions) {
    std::map<std::array<double, 3>, std::size_t> first;
    std::vector<std::size_t> welded;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        welded.push_back(first.try_emplace({p.x, p.y, p.z}, v).first->second);
    }
    Sets shells(welded.size()), patches(welded.size());
    std::set<std::size_t> used;
    const std::vector<std::uint32_t> corners = mesh.triangles();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t a = welded[corners[i]], b = welded[corners[i - i % 3 + (i + 1) % 3]];
        used.insert(a);
        shells.join(a, b);
        if (regions[a] == regions[b]) patches.join(a, b);
    }
    std::set<std::pair<std::size_t, std::uint32_t>> expected;
    std::set<std::size_t> found;
    for (const std::size_t v : used) {
        expected.emplace(shells.find(v), regions[v]);
        found.insert(patches.find(v));
    }
    return found.size() - expected.size();
}
