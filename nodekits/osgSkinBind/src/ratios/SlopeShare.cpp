// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/SlopeShare.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Where a field counts as neither 0 nor 1.
constexpr double kBetween = 0.02;

/// A single needle of the mesh must not spread a field over the body.
constexpr double kMost = 3.0;

/// The length of a field's gradient at each vertex, from its edges: in the mean over all directions
/// the square of the slope along an edge is half of the gradient's.
std::vector<double> slopes(const WeldedMesh& mesh, const std::vector<double>& field) {
    std::vector<double> result(field.size(), 0.0);
    for (std::uint32_t v = 0; v < field.size(); ++v) {
        double squares = 0.0, count = 0.0;
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            const std::uint32_t next = mesh.neighbours[i];
            const double length = glm::distance(mesh.positions[v], mesh.positions[next]);
            if (!(length > 0.0)) continue;
            const double slope = (field[next] - field[v]) / length;
            squares += slope * slope;
            count += 1.0;
        }
        if (count > 0.0) result[v] = std::sqrt(2.0 * squares / count);
    }
    return result;
}

double slopeBetween(const std::vector<double>& field, const std::vector<double>& slope) {
    double squares = 0.0, count = 0.0;
    for (std::size_t v = 0; v < field.size(); ++v) {
        if (!(field[v] > kBetween && field[v] < 1.0 - kBetween)) continue;
        squares += slope[v] * slope[v];
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

} // namespace

std::vector<double> slopeShare(const WeldedMesh& mesh, const std::vector<double>& field) {
    const std::vector<double> slope = slopes(mesh, field);
    const double between = slopeBetween(field, slope);
    std::vector<double> share(field.size(), 1.0);
    if (!(between > 0.0)) return share;
    for (std::uint32_t v = 0; v < share.size(); ++v) {
        double sum = slope[v], count = 1.0;
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            sum += slope[mesh.neighbours[i]];
            count += 1.0;
        }
        share[v] = std::clamp(sum / (count * between), 1.0, kMost);
    }
    return share;
}

} // namespace osgSkin
