// SPDX-License-Identifier: GPL-3.0-or-later
#include "layers/FindAttached.h"

#include "layers/RegionTree.h"
#include "layers/ShellOrder.h"
#include "limbs/HermiteRatio.h"
#include "mesh/NearestPoints.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>
#include <utility>

namespace osgSkin {
namespace {

/// Distances, in radii of the limb, up to which a layer is held wholly, and from which not at all.
constexpr double kHeld = 0.5;
constexpr double kLoose = 1.0;
/// The radius, in the skin's size, of what is no limb.
constexpr double kNoRadius = 0.02;

/// What lies on a surface is above it, not beside it: the least part of the distance that is along
/// the normal. Nearer than this, in radii, nobody can tell.
constexpr double kAbove = 0.7;
constexpr double kTouching = 0.02;

/// So many shells at most may have others on them: a beard of 10,000 hairs has none.
constexpr std::size_t kMostBelow = 16;

/// A joint is of the shell that has so many times more of its seeds than those below.
constexpr std::size_t kCarried = 4;
/// An eye is embedded: so much of it is near the shells below.
constexpr double kEmbedded = 0.8;

class Finder {
public:
    Finder(const WeldedMesh& mesh, const Regions& regions, const std::vector<PlannedJoint>& joints,
           const std::vector<double>& radii)
        : _mesh(mesh), _regions(regions), _joints(joints), _tree(joints), _radii(radii),
          _seedsBelow(joints.size()) {}

    /// Adds what of a shell is attached to those before.
    void attach(const std::vector<std::uint32_t>& vertices) {
        std::vector<Attached> near;
        for (const std::uint32_t v : vertices)
            if (const auto attached = attachedAt(v)) near.push_back(*attached);
        keep(near, vertices);
    }

    /// Lets those that follow lie on a shell.
    void add(std::uint32_t shell, const std::vector<std::uint32_t>& vertices) {
        if (_below.size() == kMostBelow) return;
        _below.push_back(std::make_unique<ShellSurface>(_mesh, shell));
        const std::vector<std::size_t> seeds = seedsOf(vertices);
        for (std::size_t j = 0; j < seeds.size(); ++j) _seedsBelow[j] += seeds[j];
    }

    std::vector<Attached> take() { return std::move(_all); }

private:
    /// Adds those that lie on the shells below.
    ///
    /// \param near each above one of them
    /// \param vertices all of the shell
    void keep(const std::vector<Attached>& near, const std::vector<std::uint32_t>& vertices) {
        const std::vector<std::size_t> seeds = seedsOf(vertices);
        const auto isCarried = [&](std::uint32_t v) {
            return seeds[_regions.jointOf[v]] > kCarried * _seedsBelow[_regions.jointOf[v]];
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

    /// The number of seeds of each joint with a region.
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

    /// The nearest that the vertex is above; one that is turned as it is, if there is one.
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
    std::vector<std::size_t> _seedsBelow; ///< in each joint's region, on these
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
