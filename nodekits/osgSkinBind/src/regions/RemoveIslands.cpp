// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/RemoveIslands.h"

#include "regions/RegionLabels.h"
#include "regions/SpreadRegions.h"

#include <array>
#include <map>
#include <utility>

namespace osgSkin {
namespace {

/// Islands of less than this share of a shell's vertices are none of a cloth's sides.
constexpr double kStray = 0.01;

struct Patch {
    std::uint32_t joint = 0;
    std::uint32_t shell = 0;
    std::size_t seeds = 0;
    std::vector<std::uint32_t> vertices;
    std::array<double, 3> place{}; ///< z, y and x of the vertex that is first by those

    /// Where two weigh the same, their places tell, which do not depend on the order of a file, and
    /// are alike on a body's left and right.
    bool outweighs(const Patch& other) const {
        if (seeds != other.seeds) return seeds > other.seeds;
        if (vertices.size() != other.vertices.size())
            return vertices.size() > other.vertices.size();
        return place < other.place;
    }
};

std::vector<Patch> findPatches(const WeldedMesh& mesh, const std::vector<bool>& isSeed,
                               const std::vector<std::uint32_t>& jointOf) {
    std::vector<Patch> patches;
    std::vector<bool> visited(mesh.vertexCount(), false);
    for (std::uint32_t start = 0; start < mesh.vertexCount(); ++start) {
        if (visited[start] || mesh.shellOf[start] == WeldedMesh::kNoShell) continue;
        Patch patch;
        patch.joint = jointOf[start];
        patch.shell = mesh.shellOf[start];
        visited[start] = true;
        patch.vertices.push_back(start);
        for (std::size_t k = 0; k < patch.vertices.size(); ++k) {
            const std::uint32_t v = patch.vertices[k];
            if (isSeed[v]) ++patch.seeds;
            const glm::dvec3& p = mesh.positions[v];
            const std::array<double, 3> place{p.z, p.y, p.x};
            if (k == 0 || place < patch.place) patch.place = place;
            for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
                const std::uint32_t next = mesh.neighbours[i];
                if (visited[next] || jointOf[next] != patch.joint) continue;
                visited[next] = true;
                patch.vertices.push_back(next);
            }
        }
        patches.push_back(std::move(patch));
    }
    return patches;
}

} // namespace

void removeIslands(const WeldedMesh& mesh, const std::vector<bool>& isSeed,
                   std::vector<std::uint32_t>& jointOf) {
    const std::vector<Patch> patches = findPatches(mesh, isSeed, jointOf);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> main; // shell and joint -> patch
    struct Shell {
        std::size_t vertices = 0, seeds = 0;
    };
    std::vector<Shell> shells(mesh.shells);
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const auto [entry, added] = main.emplace(std::pair(patches[p].shell, patches[p].joint), p);
        shells[patches[p].shell].vertices += patches[p].vertices.size();
        shells[patches[p].shell].seeds += patches[p].seeds;
        if (!added && patches[p].outweighs(patches[entry->second])) entry->second = p;
    }
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const Patch& patch = patches[p];
        if (main.at({patch.shell, patch.joint}) == p) continue;
        const Shell& shell = shells[patch.shell];
        const double share =
            static_cast<double>(patch.vertices.size()) / static_cast<double>(shell.vertices);
        if (shell.seeds > 0 || share < kStray)
            for (const std::uint32_t v : patch.vertices) jointOf[v] = Regions::kNone;
    }
    // Each shell keeps at least one patch, so spreading reaches all of it again, and what it adds
    // is connected to the patch that it comes from.
    spreadRegions(mesh, jointOf);
}

} // namespace osgSkin
