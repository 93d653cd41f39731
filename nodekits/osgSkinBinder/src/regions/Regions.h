// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_REGIONS_REGIONS_H
#define OSGSKINBINDER_REGIONS_REGIONS_H

#include "joints/JointRegions.h"
#include "mesh/WeldedMesh.h"

#include <osgSkinBind/Progress>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Every welded vertex's region (paper, section 1).
struct Regions {
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::vector<std::uint32_t> jointOf; ///< joint index of each welded vertex
    std::vector<std::uint32_t> seedOf;  ///< the Delaunay step's label, or kNone
    /// For each vertex, whether its whole shell belongs to its joint, so that no plane divides it.
    /// Empty if this is true of no vertex.
    std::vector<bool> isWhole;
    std::vector<std::size_t> seeds; ///< for each joint, vertices labelled by the Delaunay step
    std::size_t rejectedEdges = 0;  ///< by normal filtering
};

/// Sets `beyond` of heads, hands and feet: all skin beyond the narrowest section of the limb
/// through the joint.
///
/// A section is the loop in which a plane cuts the skin around the limb. The skin is parted along
/// it, and everything connected beyond it belongs to the extremity, even if it hangs below the
/// plane: a chin, or the inside of the mouth. Nothing is set if no plane cuts a loop that parts the
/// skin, as on open or coarse meshes.
///
/// \param mesh the skin
/// \param joints of planJoints()
void findExtremities(const WeldedMesh& mesh, std::vector<PlannedJoint>& joints);

/// Finds a region for every vertex: Delaunay step, flooding step, then corrections that real meshes
/// need (shells without a Delaunay edge, islands).
///
/// \param mesh the skin
/// \param joints of findExtremities(); `beyond` is cleared where most skin of the joint's chains is
///        on the near side
/// \param progress is called at the start of each step; may be empty
Regions findRegions(const WeldedMesh& mesh, std::vector<PlannedJoint>& joints,
                    const Progress& progress);

/// True for skin that faces a limb's bone across the air, as the side of the torso faces an arm
/// that hangs down beside it: its own bone lies behind it.
///
/// \param limb the joint whose bone is tested
/// \param radius of the limb at its joint, of limbRadii()
/// \param position of a vertex, rest space
/// \param normal of the vertex, outwards
bool facesLimb(const PlannedJoint& limb, double radius, const glm::dvec3& position,
               const glm::dvec3& normal);

} // namespace osgSkin

#endif
