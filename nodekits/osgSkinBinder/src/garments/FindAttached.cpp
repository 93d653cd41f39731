// SPDX-License-Identifier: GPL-3.0-or-later
#include "garments/SkinLayers.h"
#include "mesh/NearestPoints.h"
#include "regions/HermiteRatio.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

namespace osgSkin {
namespace {

/// The shells from the bones outwards, by the area that the Delaunay step labelled, then by area. A
/// body comes before its clothes even if the clothes are larger.
std::vector<std::uint32_t> orderedShells(const WeldedMesh& mesh, const Regions& regions) {
    std::vector<std::pair<double, double>> rank(mesh.shells); // labelled area, area
    for (const auto& t : mesh.triangles) {
        const glm::dvec3& a = mesh.positions[t[0]];
        const double twice =
            glm::length(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
        auto& [seen, area] = rank[mesh.shellOf[t[0]]];
        area += twice;
        for (const std::uint32_t v : t)
            if (regions.seedOf[v] != Regions::kNone) seen += twice;
    }
    std::vector<std::uint32_t> order(mesh.shells);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return rank[a] > rank[b]; });
    return order;
}

/// The distances of regions along the limbs.
class RegionTree {
public:
    explicit RegionTree(const std::vector<PlannedJoint>& joints) {
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const auto above = static_cast<std::uint32_t>(j == 0 ? 0 : regionAbove(joints, j));
            const bool ofTrunk = j == 0 || joints[j].isOfTrunk();
            _above.push_back(above);
            _depths.push_back(ofTrunk ? 0 : _depths[above] + 1);
        }
    }

    /// True if skin of one region may lie on skin of the other: if both are of the trunk, or of the
    /// same limb and at most two steps apart, where the whole trunk is one step. Skin of one leg
    /// does not lie on the other leg, nor a hand on the hips, however near they are at rest.
    bool mayTouch(std::uint32_t a, std::uint32_t b) const {
        int steps = 0;
        while (a != b && (depth(a) > 0 || depth(b) > 0)) {
            // Two limbs meet only in the trunk.
            if (depth(a) == 1 && depth(b) == 1) return false;
            std::uint32_t& deeper = depth(a) >= depth(b) ? a : b;
            deeper = _above[deeper];
            if (++steps > kStepsApart) return false;
        }
        return true;
    }

private:
    static constexpr int kStepsApart = 2;

    /// Steps from a joint's region to the trunk; 0 in the trunk.
    int depth(std::uint32_t joint) const { return _depths[joint]; }

    std::vector<std::uint32_t> _above; ///< for each joint, the region above its own
    std::vector<int> _depths;
};

/// Distances, in limb radii, up to which a layer follows fully, and from which it does not follow.
constexpr double kHeld = 0.5;
constexpr double kLoose = 1.0;
/// The radius, in the skin's size, to use if a joint has none.
constexpr double kNoRadius = 0.02;

/// A vertex lies above a surface, not beside it, if at least this share of its offset is along the
/// normal. Below kTouching, in radii, the direction of the offset is meaningless.
constexpr double kAbove = 0.7;
constexpr double kTouching = 0.02;

/// The largest number of shells that others may lie on; a beard may have 10,000 hairs.
constexpr std::size_t kMaxBelow = 16;

/// A shell carries a joint if it has this many times more of the joint's seeds than those below.
constexpr std::size_t kCarried = 4;
/// A shell such as an eye is embedded if this share of it is near the shells below.
constexpr double kEmbedded = 0.8;

class Finder {
public:
    Finder(const WeldedMesh& mesh, const Regions& regions, const std::vector<PlannedJoint>& joints,
           const std::vector<double>& radii)
        : _mesh(mesh), _regions(regions), _joints(joints), _tree(joints), _radii(radii),
          _seedsBelow(joints.size()), _isBelow(mesh.shells, false) {}

    /// Adds the vertices of a shell that are attached to earlier shells.
    void attach(const std::vector<std::uint32_t>& vertices) {
        std::vector<Attached> near;
        for (const std::uint32_t v : vertices)
            if (const auto attached = attachedAt(v)) near.push_back(*attached);
        keep(near, vertices);
    }

    /// Lets later shells lie on a shell.
    void add(std::uint32_t shell, const std::vector<std::uint32_t>& vertices) {
        if (_below.size() == kMaxBelow) return;
        _below.push_back(std::make_unique<ShellSurface>(_mesh, shell));
        _isBelow[shell] = true;
        const std::vector<std::size_t> seeds = seedsOf(vertices);
        for (std::size_t j = 0; j < seeds.size(); ++j) _seedsBelow[j] += seeds[j];
    }

    std::vector<Attached> take() { return std::move(_all); }

private:
    /// Adds the attached vertices of a shell.
    ///
    /// \param near the shell's vertices that are above a shell below
    /// \param vertices all vertices of the shell
    void keep(const std::vector<Attached>& near, const std::vector<std::uint32_t>& vertices) {
        if (near.empty()) return;
        const std::vector<std::size_t> seeds = seedsOf(vertices);
        const std::vector<bool> runsHere = bonesOnlyIn(_mesh.shellOf[vertices.front()]);
        const auto isCarried = [&](std::uint32_t v) {
            const std::uint32_t joint = _regions.jointOf[v];
            return seeds[joint] > kCarried * _seedsBelow[joint] || runsHere[joint];
        };
        const auto carried =
            static_cast<double>(std::count_if(vertices.begin(), vertices.end(), isCarried));
        const auto all = static_cast<double>(vertices.size());
        if (carried > 0.5 * all && static_cast<double>(near.size()) > kEmbedded * all) return;
        std::vector<std::uint32_t> held, turnedAway;
        std::unordered_map<std::uint32_t, std::size_t> found;
        for (const Attached& attached : near) {
            if (isCarried(attached.vertex)) continue;
            if (!isAlike(attached)) {
                turnedAway.push_back(attached.vertex);
            } else {
                found.emplace(attached.vertex, _all.size());
                held.push_back(attached.vertex);
                _all.push_back(attached);
            }
        }
        if (held.empty() || turnedAway.empty()) return;
        const std::vector<std::uint32_t> nearest = nearestPoints(_mesh.positions, held, turnedAway);
        for (std::size_t i = 0; i < nearest.size(); ++i) {
            Attached attached = _all[found.at(nearest[i])];
            const double distance = distanceBetween(turnedAway[i], nearest[i]);
            attached.vertex = turnedAway[i];
            attached.gap = glm::distance(_mesh.positions[turnedAway[i]], attached.on.position);
            attached.hold = std::min(attached.hold, holdAt(turnedAway[i], distance));
            if (attached.hold > 0.0) _all.push_back(attached);
        }
    }

    /// For each joint, whether most of its bone that is inside a shell is in no shell below: it is
    /// a piece of a modular figure, as a leg that is a shell of its own, and no garment.
    std::vector<bool> bonesOnlyIn(std::uint32_t shell) {
        if (_shellsAround.empty())
            for (const PlannedJoint& joint : _joints)
                for (const glm::dvec3& sample : joint.samples)
                    _shellsAround.push_back(shellsAround(_mesh, sample, false));
        std::vector<bool> result(_joints.size(), false);
        auto around = _shellsAround.begin();
        for (std::size_t j = 0; j < result.size(); ++j) {
            std::size_t here = 0, onlyHere = 0;
            for (std::size_t s = 0; s < _joints[j].samples.size(); ++s, ++around) {
                if (std::find(around->begin(), around->end(), shell) == around->end()) continue;
                ++here;
                onlyHere += std::none_of(around->begin(), around->end(),
                                         [this](std::uint32_t a) { return _isBelow[a]; });
            }
            result[j] = 2 * onlyHere > here;
        }
        return result;
    }

    /// For each joint, the number of its seeds among the vertices.
    std::vector<std::size_t> seedsOf(const std::vector<std::uint32_t>& vertices) const {
        std::vector<std::size_t> seeds(_seedsBelow.size());
        for (const std::uint32_t v : vertices) {
            const std::uint32_t seed = _regions.seedOf[v];
            if (seed == Regions::kNone) continue;
            const int rigid = _joints[seed].rigid;
            ++seeds[rigid >= 0 ? static_cast<std::size_t>(rigid) : seed];
        }
        return seeds;
    }

    double radiusAt(std::uint32_t v) const {
        const double radius = _radii[_regions.jointOf[v]];
        return radius > 0.0 ? radius : kNoRadius * _mesh.size;
    }

    double distanceBetween(std::uint32_t a, std::uint32_t b) const {
        return glm::distance(_mesh.positions[a], _mesh.positions[b]);
    }

    double holdAt(std::uint32_t v, double distance) const {
        const double radii = distance / radiusAt(v);
        return hermiteRatio((kLoose - radii) / (kLoose - kHeld));
    }

    /// The nearest point that the vertex is above; preferably one with a similar normal.
    std::optional<Attached> attachedAt(std::uint32_t v) const {
        const glm::dvec3& point = _mesh.positions[v];
        const double reach = kLoose * radiusAt(v);
        std::optional<Attached> best;
        for (const auto& shell : _below) {
            const std::optional<SurfacePoint> nearest = shell->nearest(point, reach);
            if (!nearest) continue;
            const double gap = glm::distance(nearest->position, point);
            const Attached attached{v, *nearest, gap, holdAt(v, gap)};
            if (attached.hold > 0.0 && isAbove(attached) && (!best || isBetter(attached, *best)))
                best = attached;
        }
        return best;
    }

    bool isBetter(const Attached& a, const Attached& b) const {
        const bool isAAlike = isAlike(a);
        return isAAlike != isAlike(b) ? isAAlike : a.gap < b.gap;
    }

    bool isAlike(const Attached& a) const {
        return glm::dot(a.on.normal, _mesh.normals[a.vertex]) > 0.0 &&
               _tree.mayTouch(_regions.jointOf[a.vertex], _regions.jointOf[a.on.nearestCorner()]);
    }

    bool isAbove(const Attached& a) const {
        const glm::dvec3 offset = _mesh.positions[a.vertex] - a.on.position;
        return std::abs(glm::dot(offset, a.on.normal)) >= kAbove * a.gap ||
               a.gap < kTouching * radiusAt(a.vertex);
    }

    const WeldedMesh& _mesh;
    const Regions& _regions;
    const std::vector<PlannedJoint>& _joints;
    const RegionTree _tree;
    const std::vector<double>& _radii;
    std::vector<std::unique_ptr<ShellSurface>> _below;
    std::vector<std::size_t> _seedsBelow; ///< of each joint, on the shells in `_below`
    std::vector<bool> _isBelow;           ///< for each shell, whether it is in `_below`
    std::vector<std::vector<std::uint32_t>> _shellsAround; ///< of all joints' samples in order
    std::vector<Attached> _all;
};

} // namespace

std::vector<Attached> findAttached(const WeldedMesh& mesh, const Regions& regions,
                                   const std::vector<PlannedJoint>& joints,
                                   const std::vector<double>& radii) {
    if (mesh.shells < 2) return {};
    std::vector<std::vector<std::uint32_t>> vertices(mesh.shells);
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        if (mesh.shellOf[v] != WeldedMesh::kNoShell) vertices[mesh.shellOf[v]].push_back(v);
    Finder finder(mesh, regions, joints, radii);
    for (const std::uint32_t shell : orderedShells(mesh, regions)) {
        finder.attach(vertices[shell]);
        finder.add(shell, vertices[shell]);
    }
    return finder.take();
}

} // namespace osgSkin
