// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_H
#define OSGSKINBIND_REGIONS_H

#include "JointPlan.h"
#include "WeldedMesh.h"

#include <osgSkinBind/BindProgress>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Every welded vertex's region (paper, section 1).
struct Regions {
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::vector<std::uint32_t> jointOf; ///< joint index of each welded vertex
    std::vector<std::uint32_t> seedOf;  ///< the Delaunay step's label, kNone without one
    std::vector<std::size_t> seeds;     ///< for each joint, vertices labelled by the Delaunay step
    std::size_t rejectedEdges = 0;      ///< by normal filtering
};

/// Delaunay step, flooding step, and what real meshes need beside them: shells that no Delaunay
/// edge reaches and islands. \param tell is called as each of these begins, with its name and the
/// share of the time that is over
Regions findRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                    const BindProgress& tell);

/// The Delaunay step alone: seeds labelled, all other vertices kNone.
Regions seedRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints);

/// The flooding step. The printed one gives an unlabelled vertex the joint of a labelled neighbour
/// until none is left, so that a region grows as far as the mesh happens to be coarse. Here a
/// vertex goes to the joint whose seeds a random walk over the skin, shy of creases, most likely
/// meets first (Grady 2006). Vertices of a shell without any label stay kNone.
void floodRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf);

/// Labels each kNone vertex like the labelled vertex that is nearest along the edges of the mesh,
/// so that what it adds to a region is connected to it.
void spreadRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf);

/// Gives joints that claim a region the vertices nearer to them than to the neighbouring joint of
/// the chain whose label they have.
void claimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                  std::vector<std::uint32_t>& jointOf);

/// Gives what lies well above a joint's plane, where it does not bend, to the region above: the
/// torso's side below a shoulder. So also what lies far from a collar bone: the chest below it.
void trimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                 std::vector<std::uint32_t>& jointOf);

/// Joins each region's islands to the regions around them: of a region's connected patches on one
/// shell the one with most seeds (then most vertices) stays.
void removeIslands(const WeldedMesh& mesh, const std::vector<bool>& isSeed,
                   std::vector<std::uint32_t>& jointOf);

/// Labels what flooding cannot reach: vertices like the nearest labelled vertex; where no vertex
/// has a label, like the nearest bone.
void assignUnreached(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                     std::vector<std::uint32_t>& jointOf);

} // namespace osgSkin

#endif
