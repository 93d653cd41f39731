// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/KeepShells.h"

#include <osgSkinRig/JointRoles>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

constexpr double kWhole = 0.99; ///< of a shell's weight, to be painted for one joint
constexpr double kMostOf = 0.5; ///< of a shell's vertices, to be a head

using Shell = std::vector<std::uint32_t>;

/// The connected pieces of a mesh, vertices at one position counting as one.
std::vector<Shell> shellsOf(const SkinMesh& mesh) {
    std::vector<std::uint32_t> up(mesh.positions.size());
    std::iota(up.begin(), up.end(), 0u);
    const auto top = [&up](std::uint32_t v) {
        while (up[v] != v) v = up[v] = up[up[v]];
        return v;
    };
    std::map<std::tuple<double, double, double>, std::uint32_t> first;
    for (std::uint32_t v = 0; v < up.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        up[v] = first.emplace(std::make_tuple(p.x, p.y, p.z), v).first->second;
    }
    const std::uint32_t* corners = mesh.faceVertices.data();
    for (const std::uint32_t size : mesh.faceSizes) {
        for (std::uint32_t k = 1; k < size; ++k) up[top(corners[k])] = top(corners[0]);
        corners += size;
    }
    std::map<std::uint32_t, Shell> shells;
    for (std::uint32_t v = 0; v < up.size(); ++v) shells[top(v)].push_back(v);
    std::vector<Shell> result;
    result.reserve(shells.size());
    for (auto& [root, shell] : shells) result.push_back(std::move(shell));
    return result;
}

/// For each joint, the topmost hand or head that it is or hangs on; -1 for none.
std::vector<int> extremities(const RestSkeleton& rest, const JointRoles& roles) {
    std::vector<int> result(rest.joints.size(), -1);
    for (std::size_t j = 1; j < result.size(); ++j) {
        result[j] = result[static_cast<std::size_t>(rest.joints[j].parent)];
        if (result[j] < 0 && (roles.is(j, JointPart::Hand) || roles.is(j, JointPart::Head)))
            result[j] = static_cast<int>(j);
    }
    return result;
}

class Keeper {
public:
    Keeper(const CharacterSource& source, const VertexWeights& weights, const Binding& binding)
        : _roles(recogniseJoints(source.rest, source.bind.names)),
          _extremities(extremities(source.rest, _roles)), _weights(weights), _binding(binding) {}

    /// The joint that a shell is to follow alone; -1 for none.
    int jointOf(const Shell& shell, bool isLargest) const {
        std::vector<double> shares(_extremities.size(), 0.0);
        double all = 0.0;
        for (const std::uint32_t v : shell) all += addShares(v, shares);
        if (!(all > 0.0) || (_weights.empty() && isLargest)) return -1;
        const auto most = std::max_element(shares.begin(), shares.end());
        const auto joint = static_cast<std::size_t>(most - shares.begin());
        const int extremity = _extremities[joint];
        if (extremity < 0) return -1;
        if (!_weights.empty() && *most >= kWhole * all) return static_cast<int>(joint);
        double under = 0.0;
        for (std::size_t j = 0; j < shares.size(); ++j)
            if (_extremities[j] == extremity) under += shares[j];
        const bool isHead = _roles.is(static_cast<std::size_t>(extremity), JointPart::Head);
        return isHead && under > (_weights.empty() ? kMostOf : kWhole) * all ? extremity : -1;
    }

private:
    /// Adds what a vertex has of each joint; without weights, of its region's.
    double addShares(std::uint32_t vertex, std::vector<double>& shares) const {
        double sum = 0.0;
        if (_weights.empty()) {
            shares[_binding.regions[vertex]] += 1.0;
            return 1.0;
        }
        for (const JointWeight& entry : _weights[vertex]) sum += entry.weight;
        if (!(sum > 0.0)) return 0.0;
        for (const JointWeight& entry : _weights[vertex]) shares[entry.joint] += entry.weight / sum;
        return 1.0;
    }

    const JointRoles _roles;
    const std::vector<int> _extremities;
    const VertexWeights& _weights;
    const Binding& _binding;
};

/// Takes correctives off vertices that do not bend.
void dropCorrectives(const std::vector<int>& jointOf, Correctives& correctives) {
    if (correctives.firstEntry.empty()) return;
    std::vector<Correctives::Entry> entries;
    std::vector<std::uint32_t> firsts{0};
    for (std::size_t v = 0; v < jointOf.size(); ++v) {
        if (jointOf[v] < 0)
            entries.insert(entries.end(), correctives.entries.begin() + correctives.firstEntry[v],
                           correctives.entries.begin() + correctives.firstEntry[v + 1]);
        firsts.push_back(static_cast<std::uint32_t>(entries.size()));
    }
    correctives.entries = std::move(entries);
    correctives.firstEntry = std::move(firsts);
}

/// Lets some vertices follow one joint, and those above it, in full. [vertex] -1: left as it is.
void follow(const std::vector<int>& jointOf, Binding& binding) {
    std::vector<Influence> influences;
    std::vector<RatioGradient> gradients;
    std::vector<std::uint32_t> firsts{0};
    for (std::size_t v = 0; v < jointOf.size(); ++v) {
        if (jointOf[v] < 0) {
            const std::uint32_t begin = binding.firstInfluence[v];
            const std::uint32_t end = binding.firstInfluence[v + 1];
            influences.insert(influences.end(), binding.influences.begin() + begin,
                              binding.influences.begin() + end);
            if (!binding.gradients.empty())
                gradients.insert(gradients.end(), binding.gradients.begin() + begin,
                                 binding.gradients.begin() + end);
        } else {
            const std::size_t begin = influences.size();
            for (int j = jointOf[v]; j >= 0; j = binding.joints[static_cast<std::size_t>(j)].parent)
                influences.push_back({static_cast<std::uint32_t>(j), 1.0f, 1.0f});
            std::reverse(influences.begin() + static_cast<std::ptrdiff_t>(begin), influences.end());
            binding.regions[v] = static_cast<std::uint32_t>(jointOf[v]);
            if (!binding.gradients.empty()) gradients.resize(influences.size());
        }
        firsts.push_back(static_cast<std::uint32_t>(influences.size()));
    }
    binding.influences = std::move(influences);
    binding.gradients = std::move(gradients);
    binding.firstInfluence = std::move(firsts);
    dropCorrectives(jointOf, binding.correctives);
}

} // namespace

std::size_t keepShells(const CharacterSource& source, const VertexWeights& weights,
                       Binding& binding) {
    const std::vector<Shell> shells = shellsOf(source.body.mesh);
    if (shells.size() < 2) return 0;
    std::size_t largest = 0;
    for (const Shell& shell : shells) largest = std::max(largest, shell.size());
    const Keeper keeper(source, weights, binding);
    std::vector<int> jointOf(binding.vertexCount(), -1);
    std::size_t kept = 0;
    for (const Shell& shell : shells) {
        const int joint = keeper.jointOf(shell, shell.size() == largest);
        if (joint < 0) continue;
        for (const std::uint32_t v : shell) jointOf[v] = joint;
        ++kept;
    }
    if (kept > 0) follow(jointOf, binding);
    return kept;
}

} // namespace osgSkin
