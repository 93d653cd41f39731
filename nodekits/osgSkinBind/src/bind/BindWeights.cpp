// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/BindWeights>

#include "bind/AddShapes.h"
#include "bind/CheckOptions.h"
#include "joints/BoundJoints.h"
#include "joints/JointPlan.h"
#include "mesh/NearestPoints.h"
#include "mesh/WeldedMesh.h"
#include "ratios/PackInfluences.h"

#include <osgSkin/Error>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

namespace osgSkin {
namespace {

/// For each welded vertex, each joint's weight; they sum to 1. Empty where nothing is painted.
using WeightRows = std::vector<std::vector<double>>;

double checkedSum(const std::vector<JointWeight>& entries, std::size_t vertex, std::size_t joints) {
    const std::string where = "bind: weights of vertex " + std::to_string(vertex);
    double sum = 0.0;
    for (const JointWeight& entry : entries) {
        if (entry.joint >= joints)
            throw Error(where + ": joint " + std::to_string(entry.joint) +
                        " is not there, expected one of " + std::to_string(joints));
        if (!std::isfinite(entry.weight) || entry.weight < 0.0)
            throw Error(where + ": expected finite numbers of 0 or more, found " +
                        std::to_string(entry.weight));
        sum += entry.weight;
    }
    return sum;
}

/// Copies of a vertex at a seam must move alike, so they take the mean of what each was given.
WeightRows weldedWeights(const WeldedMesh& skin, const VertexWeights& weights, std::size_t joints) {
    WeightRows rows(skin.vertexCount());
    std::vector<double> copies(skin.vertexCount(), 0.0);
    for (std::size_t v = 0; v < weights.size(); ++v) {
        const double sum = checkedSum(weights[v], v, joints);
        if (!(sum > 0.0)) continue;
        std::vector<double>& row = rows[skin.weldedOf[v]];
        row.resize(joints, 0.0);
        for (const JointWeight& entry : weights[v]) row[entry.joint] += entry.weight / sum;
        copies[skin.weldedOf[v]] += 1.0;
    }
    for (std::size_t v = 0; v < rows.size(); ++v)
        for (double& weight : rows[v]) weight /= copies[v];
    return rows;
}

/// Fills in what nobody painted. Returns how many welded vertices that were.
std::size_t fillGaps(const WeldedMesh& skin, WeightRows& rows) {
    std::vector<std::uint32_t> painted, gaps;
    for (std::uint32_t v = 0; v < rows.size(); ++v) (rows[v].empty() ? gaps : painted).push_back(v);
    if (painted.empty()) throw Error("bind: no vertex has weights, expected at least one above 0");
    const std::vector<std::uint32_t> nearest = nearestPoints(skin.positions, painted, gaps);
    for (std::size_t i = 0; i < gaps.size(); ++i) rows[gaps[i]] = rows[nearest[i]];
    return gaps.size();
}

/// The ratio of each joint is what its subtree has of the weights. Adding up from the leaves keeps
/// it at or below the parent's, to the last bit.
JointFields ratiosFrom(const std::vector<double>& weights,
                       const std::vector<PlannedJoint>& joints) {
    std::vector<double> sums = weights;
    for (std::size_t j = joints.size(); j-- > 1;)
        sums[static_cast<std::size_t>(joints[j].parent)] += sums[j];
    JointFields fields(joints.size(), std::vector<double>(1, 1.0));
    for (std::size_t j = 1; j < joints.size(); ++j) fields[j][0] = sums[j] / sums[0];
    return fields;
}

std::vector<BindReport::Region> regionsOf(const Binding& binding) {
    std::vector<BindReport::Region> all(binding.joints.size());
    for (const std::uint32_t joint : binding.regions) ++all[joint].vertices;
    std::vector<BindReport::Region> result;
    for (std::size_t j = 0; j < all.size(); ++j) {
        if (all[j].vertices == 0) continue;
        all[j].joint = binding.joints[j].name;
        result.push_back(all[j]);
    }
    return result;
}

} // namespace

bool isWellPainted(const VertexWeights& weights) {
    std::size_t painted = 0;
    std::set<std::uint32_t> joints;
    for (const std::vector<JointWeight>& list : weights) {
        bool any = false;
        for (const JointWeight& entry : list) {
            if (!(entry.weight > 0.0)) continue;
            any = true;
            joints.insert(entry.joint);
        }
        painted += any ? 1 : 0;
    }
    return joints.size() > 1 &&
           static_cast<double>(painted) >= 0.98 * static_cast<double>(weights.size());
}

Binding bindWeights(const SkinMesh& mesh, const RestSkeleton& skeleton,
                    const VertexWeights& weights, const BindOptions& asked, BindReport* report) {
    const auto start = std::chrono::steady_clock::now();
    mesh.validate();
    skeleton.validate();
    checkOptions(skeleton, asked);
    const BindOptions options = decided(asked, false);
    if (weights.size() != mesh.positions.size())
        throw Error("bind: weights for " + std::to_string(weights.size()) +
                    " vertices, expected one list for each of the mesh's " +
                    std::to_string(mesh.positions.size()));

    BindReport found;
    const WeldedMesh skin(mesh);
    std::vector<std::string> aboutRegions; // which are not looked for here
    const std::vector<PlannedJoint> joints = planJoints(skeleton, skin, options, aboutRegions);
    WeightRows rows = weldedWeights(skin, weights, joints.size());
    if (const std::size_t gaps = fillGaps(skin, rows))
        found.notes.push_back(std::to_string(gaps) +
                              " vertices have no weights, they take those of the nearest that has");

    Binding binding;
    binding.joints = boundJoints(skeleton, joints);
    binding.firstInfluence.push_back(0);
    std::size_t partial = 0;
    for (const std::uint32_t v : skin.weldedOf) {
        const auto heaviest = std::max_element(rows[v].begin(), rows[v].end());
        binding.regions.push_back(static_cast<std::uint32_t>(heaviest - rows[v].begin()));
        const JointFields ratios = ratiosFrom(rows[v], joints);
        if (packInfluences(joints, ratios, ratios, 0, options.maxPartialInfluences,
                           binding.influences))
            ++found.cappedVertices;
        for (std::size_t i = binding.firstInfluence.back(); i < binding.influences.size(); ++i)
            if (binding.influences[i].isFractional()) ++partial;
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    addShapes(skeleton, joints, skin, options, options.progress, binding, found.notes);
    binding.validate();

    found.regions = regionsOf(binding);
    found.vertices = mesh.positions.size();
    found.weldedVertices = skin.vertexCount();
    found.shells = skin.shells;
    found.openEdges = skin.openEdges;
    found.influencesPerVertex = static_cast<double>(partial) / static_cast<double>(found.vertices);
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (report) *report = found;
    return binding;
}

} // namespace osgSkin
