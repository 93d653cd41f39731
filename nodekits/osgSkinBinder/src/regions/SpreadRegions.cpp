// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/SpreadRegions.h"

#include "mesh/HeatGraph.h"
#include "regions/Regions.h"

#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

namespace osgSkin {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// The vertices without a label on shells that have some, numbered; -1 elsewhere.
std::vector<int> numberUnlabelled(const WeldedMesh& mesh, const std::vector<std::uint32_t>& jointOf,
                                  int& count) {
    std::vector<bool> hasLabel(mesh.shells, false);
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        if (jointOf[v] != Regions::kNone && mesh.shellOf[v] != WeldedMesh::kNoShell)
            hasLabel[mesh.shellOf[v]] = true;
    std::vector<int> row(mesh.vertexCount(), -1);
    count = 0;
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        if (jointOf[v] == Regions::kNone && mesh.shellOf[v] != WeldedMesh::kNoShell &&
            hasLabel[mesh.shellOf[v]])
            row[v] = count++;
    return row;
}

std::vector<std::uint32_t> labelsOf(const std::vector<std::uint32_t>& jointOf) {
    std::vector<std::uint32_t> labels;
    for (const std::uint32_t joint : jointOf)
        if (joint != Regions::kNone) labels.push_back(joint);
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    return labels;
}

/// Islands smaller than this share of a shell's vertices are not a side of a cloth.
constexpr double kStray = 0.01;

struct Patch {
    std::uint32_t joint = 0;
    std::uint32_t shell = 0;
    std::size_t seeds = 0;
    std::vector<std::uint32_t> vertices;
    std::array<double, 3> place{}; ///< z, y and x of the vertex that comes first in this order

    /// Positions decide between patches of the same weight: they do not depend on the order of a
    /// file, and are alike on a body's left and right.
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
            for (const std::uint32_t next : mesh.neighboursOf(v)) {
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

void floodRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf) {
    int count = 0;
    const std::vector<int> row = numberUnlabelled(mesh, jointOf, count);
    if (count == 0) return;
    const std::vector<std::uint32_t> labels = labelsOf(jointOf);
    const std::vector<double> weights = edgeWeights(mesh);

    // A walk goes to each neighbour with a probability proportional to the edge's weight, reduced
    // across creases. Its probability of reaching a joint's seeds first is harmonic: one linear
    // system for all joints.
    std::vector<Eigen::Triplet<double>> entries;
    struct Exit {
        int row;
        std::uint32_t label;
        double weight;
    };
    std::vector<Exit> exits; // to seeds
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        if (row[v] < 0) continue;
        double sum = 0.0;
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            const std::uint32_t next = mesh.neighbours[i];
            const double weight = weights[i] / creaseFactor(mesh, v, next);
            sum += weight;
            if (row[next] >= 0)
                entries.emplace_back(row[v], row[next], -weight);
            else
                exits.push_back({row[v], jointOf[next], weight});
        }
        entries.emplace_back(row[v], row[v], sum);
    }
    Matrix walk(count, count);
    walk.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Matrix> solver(walk);
    if (solver.info() != Eigen::Success) return spreadRegions(mesh, jointOf);
    entries = {};
    Eigen::VectorXd best = Eigen::VectorXd::Constant(count, -1.0);
    std::vector<std::uint32_t> likeliest(static_cast<std::size_t>(count));
    for (const std::uint32_t label : labels) { // one at a time, as there may be hundreds
        Eigen::VectorXd chances = Eigen::VectorXd::Zero(count);
        for (const Exit& exit : exits)
            if (exit.label == label) chances[exit.row] += exit.weight;
        chances = solver.solve(chances).eval();
        for (int i = 0; i < count; ++i) {
            if (!(chances[i] > best[i])) continue;
            best[i] = chances[i];
            likeliest[static_cast<std::size_t>(i)] = label;
        }
    }
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        if (row[v] >= 0) jointOf[v] = likeliest[static_cast<std::size_t>(row[v])];
}

void spreadRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf) {
    // Dijkstra's shortest paths from all labelled vertices at once.
    using Step = std::tuple<double, std::uint32_t, std::uint32_t>; // length, vertex, joint
    std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
    std::vector<double> length(mesh.vertexCount(), std::numeric_limits<double>::infinity());
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        if (jointOf[v] != Regions::kNone) {
            length[v] = 0.0;
            front.emplace(0.0, v, jointOf[v]);
        }
    std::vector<bool> settled(mesh.vertexCount(), false);
    while (!front.empty()) {
        const auto [reached, v, joint] = front.top();
        front.pop();
        if (settled[v]) continue;
        settled[v] = true;
        jointOf[v] = joint;
        for (const std::uint32_t next : mesh.neighboursOf(v)) {
            const double there = reached + glm::distance(mesh.positions[v], mesh.positions[next]) *
                                               creaseFactor(mesh, v, next);
            if (there < length[next]) {
                length[next] = there;
                front.emplace(there, next, joint);
            }
        }
    }
}

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
    // Each shell keeps at least one patch, so spreading reaches all of it again. What it adds is
    // connected to the patch from which it spreads.
    spreadRegions(mesh, jointOf);
}

} // namespace osgSkin
