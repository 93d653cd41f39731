// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/FloodRegions.h"

#include "mesh/EdgeWeights.h"
#include "regions/RegionLabels.h"
#include "regions/SpreadRegions.h"

#include <Eigen/SparseCholesky>

#include <algorithm>

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

} // namespace

void floodRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf) {
    int count = 0;
    const std::vector<int> row = numberUnlabelled(mesh, jointOf, count);
    if (count == 0) return;
    const std::vector<std::uint32_t> labels = labelsOf(jointOf);
    const std::vector<double> weights = edgeWeights(mesh);

    // A walk goes to each neighbour with a probability in proportion to the edge's weight, less
    // across creases. Its chance to meet a joint's seeds first is harmonic: one linear system for
    // all joints.
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd chances =
        Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(labels.size()));
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
                chances(row[v], std::lower_bound(labels.begin(), labels.end(), jointOf[next]) -
                                    labels.begin()) += weight;
        }
        entries.emplace_back(row[v], row[v], sum);
    }
    Matrix walk(count, count);
    walk.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Matrix> solver(walk);
    if (solver.info() != Eigen::Success) return spreadRegions(mesh, jointOf);
    chances = solver.solve(chances).eval();
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        if (row[v] < 0) continue;
        Eigen::Index likeliest = 0;
        chances.row(row[v]).maxCoeff(&likeliest);
        jointOf[v] = labels[static_cast<std::size_t>(likeliest)];
    }
}

} // namespace osgSkin
