// SPDX-License-Identifier: MIT
#include <osgSkinBind/BindWeights>

#include "bind/Binder.h"
#include "bind/CheckOptions.h"
#include "joints/JointPlan.h"
#include "mesh/NearestPoints.h"
#include "mesh/WeldedMesh.h"
#include "ratios/JointRatios.h"
#include "ratios/PackInfluences.h"

#include <osgSkin/Error>
#include <osgSkin/SkinModel>
#include <osgSkinRig/JointRoles>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <set>

namespace osgSkin {
namespace {

struct JointShare {
    std::uint32_t joint;
    double weight;
};
/// For each welded vertex, the joints that have weights there, in their order, with sum 1. Empty at
/// vertices without weights.
using WeightRows = std::vector<std::vector<JointShare>>;

double checkedSum(const std::vector<JointWeight>& entries, std::size_t vertex, std::size_t joints) {
    const std::string where = "bind: weights of vertex " + std::to_string(vertex);
    double sum = 0.0;
    for (const JointWeight& entry : entries) {
        if (entry.joint >= joints)
            throw Error(where + ": joint " + std::to_string(entry.joint) +
                        " does not exist, expected one of " + std::to_string(joints));
        if (!std::isfinite(entry.weight) || entry.weight < 0.0)
            throw Error(where + ": expected finite numbers of 0 or more, found " +
                        std::to_string(entry.weight));
        sum += entry.weight;
    }
    if (!std::isfinite(sum)) throw Error(where + ": expected weights with a finite sum");
    return sum;
}

/// Combines several entries of a joint.
void addUp(std::vector<JointShare>& row) {
    std::stable_sort(row.begin(), row.end(),
                     [](const JointShare& a, const JointShare& b) { return a.joint < b.joint; });
    std::size_t count = 0;
    for (const JointShare& share : row) {
        if (count > 0 && row[count - 1].joint == share.joint)
            row[count - 1].weight += share.weight;
        else
            row[count++] = share;
    }
    row.resize(count);
}

/// Copies of a vertex at a seam must move alike, so they get the mean of their weights.
WeightRows weldedWeights(const WeldedMesh& skin, const VertexWeights& weights, std::size_t joints) {
    WeightRows rows(skin.vertexCount());
    std::vector<double> copies(skin.vertexCount(), 0.0);
    for (std::size_t v = 0; v < weights.size(); ++v) {
        const double sum = checkedSum(weights[v], v, joints);
        if (!(sum > 0.0)) continue;
        std::vector<JointShare>& row = rows[skin.weldedOf[v]];
        for (const JointWeight& entry : weights[v])
            row.push_back({entry.joint, entry.weight / sum});
        copies[skin.weldedOf[v]] += 1.0;
    }
    for (std::size_t v = 0; v < rows.size(); ++v) {
        addUp(rows[v]);
        for (JointShare& share : rows[v]) share.weight /= copies[v];
    }
    return rows;
}

/// Gives welded vertices without weights those of the nearest vertex. Returns their number.
std::size_t inferMissingRoles(const WeldedMesh& skin, WeightRows& rows) {
    std::vector<std::uint32_t> painted, gaps;
    for (std::uint32_t v = 0; v < rows.size(); ++v) (rows[v].empty() ? gaps : painted).push_back(v);
    if (painted.empty()) throw Error("bind: no vertex has weights, expected at least one above 0");
    const std::vector<std::uint32_t> nearest = nearestPoints(skin.positions, painted, gaps);
    for (std::size_t i = 0; i < gaps.size(); ++i) rows[gaps[i]] = rows[nearest[i]];
    return gaps.size();
}

bool isLess(const JointShare& a, const JointShare& b) {
    return a.weight < b.weight;
}

/// Computes ratios from weights, in memory that is reused for each vertex.
class WeightRatios {
public:
    explicit WeightRatios(const std::vector<PlannedJoint>& joints)
        : _joints(joints), _sums(joints.size()) {}

    /// The ratio of each joint is the sum of the weights in its subtree. Sums from the leaves up
    /// never exceed the parent's, not even by rounding.
    const std::vector<JointRatio>& of(const std::vector<JointShare>& weights) {
        std::fill(_sums.begin(), _sums.end(), 0.0);
        for (const JointShare& share : weights) _sums[share.joint] = share.weight;
        for (std::size_t j = _joints.size(); j-- > 1;)
            _sums[static_cast<std::size_t>(_joints[j].parent)] += _sums[j];
        _ratios.assign(1, {0, 1.0, 1.0});
        for (std::uint32_t j = 1; j < _joints.size(); ++j)
            if (_sums[j] > 0.0) _ratios.push_back({j, _sums[j] / _sums[0], _sums[j] / _sums[0]});
        return _ratios;
    }

    /// Appends a vertex's influences, as packInfluences() does, of which more than `most` may be
    /// partial where its joints are on several branches.
    /// \return whether some were left out
    bool pack(std::vector<JointShare> weights, std::size_t most,
              std::vector<Influence>& influences) {
        of(weights);
        bool isCapped = false;
        if (partial() > most && isBranched()) {
            most = SkinModel::kMaxPartialInfluences;
            while (partial() > most) { // leaves out the least weight
                weights.erase(std::min_element(weights.begin(), weights.end(), isLess));
                of(weights);
                isCapped = true;
            }
        }
        return packInfluences(_ratios, most, influences) || isCapped;
    }

private:
    /// Whether the last ratios' joints are not all on one way from the root: these cannot be
    /// stretched, since those side by side would be followed in full together, or not at all.
    bool isBranched() const {
        for (std::size_t r = 1; r < _ratios.size(); ++r)
            if (_joints[_ratios[r].joint].parent != static_cast<int>(_ratios[r - 1].joint))
                return true;
        return false;
    }

    /// How many of the last ratios are partial.
    std::size_t partial() const {
        constexpr double kNothing = 1e-4; // as packInfluences() has it
        return static_cast<std::size_t>(
            std::count_if(_ratios.begin(), _ratios.end(), [](const JointRatio& ratio) {
                return ratio.bend >= kNothing && ratio.bend <= 1.0 - kNothing;
            }));
    }

    const std::vector<PlannedJoint>& _joints;
    std::vector<double> _sums;
    std::vector<JointRatio> _ratios;
};

/// \param rows none of them empty
std::vector<std::uint32_t> heaviestJoints(const WeightRows& rows) {
    std::vector<std::uint32_t> result;
    result.reserve(rows.size());
    for (const auto& row : rows)
        result.push_back(std::max_element(row.begin(), row.end(), isLess)->joint);
    return result;
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

/// Share of the vertices; the others take weights of their neighbours.
constexpr double kPainted = 0.9;

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
    const bool isPlaceholder = joints.empty() || (joints.size() == 1 && *joints.begin() == 0);
    return !isPlaceholder &&
           static_cast<double>(painted) >= kPainted * static_cast<double>(weights.size());
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
    const WeldedMesh skin(mesh, WeldedMesh::kCopies);
    const std::vector<PlannedJoint> joints =
        planAxes(skeleton, skin, recogniseJoints(skeleton, options.names), options);
    WeightRows rows = weldedWeights(skin, weights, joints.size());
    if (const std::size_t gaps = inferMissingRoles(skin, rows))
        found.notes.push_back(std::to_string(gaps) +
                              " vertices have no weights, they take those of the nearest that has");

    const std::vector<std::uint32_t> heaviest = heaviestJoints(rows);
    checkInfluences(joints, heaviest, skin.weldedOf, options.maxInfluences);

    Binding binding;
    binding.joints = boundJoints(skeleton, joints);
    binding.firstInfluence.push_back(0);
    WeightRatios ratios(joints);
    std::size_t partial = 0;
    for (const std::uint32_t v : skin.weldedOf) {
        binding.regions.push_back(heaviest[v]);
        if (ratios.pack(rows[v], options.maxPartialInfluences, binding.influences))
            ++found.cappedVertices;
        for (std::size_t i = binding.firstInfluence.back(); i < binding.influences.size(); ++i)
            if (binding.influences[i].isFractional()) ++partial;
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    if (options.shapes != BindOptions::Shapes::None || options.muscles ||
        !options.ownMuscles.empty())
        Binder::find("bind: a shape or a muscle")
            ->completeWeights(mesh, skeleton, options, binding, found.notes);
    else if (*options.surfaceNormals)
        binding.gradients = ratioGradients(skin, binding);
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
