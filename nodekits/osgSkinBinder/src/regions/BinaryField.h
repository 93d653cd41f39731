// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_REGIONS_BINARYFIELD_H
#define OSGSKINBINDER_REGIONS_BINARYFIELD_H

#include "joints/JointRegions.h"
#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The start of a joint's bend field: regions and planes only, not yet continuous.
struct BinaryField {
    const WeldedMesh& mesh;
    const std::vector<PlannedJoint>& joints;
    const std::vector<std::uint32_t>& regions; ///< joint index of each welded vertex
    std::vector<bool> isWhole{};               ///< see Regions; vertices that no plane divides

    /// 1 over the subtree's regions and, in the joint's own region, below the joint's plane, which
    /// bisects the bone above and its own; else 0.
    ///
    /// A spine joint divides the regions of the whole spine, whose skin is near several joints. A
    /// joint with a border of its own (PlannedJoint::beyond) takes its whole region, and so does a
    /// rigid part whose bone is longer than the one above. Skin in the middle between two limbs, as
    /// of a skirt, is 0.5 for both.
    ///
    /// \param joint index in `joints`
    /// \param shift of the plane, towards the child
    /// \return one value for each welded vertex
    std::vector<double> divided(std::size_t joint, double shift = 0.0) const;

    /// The paper's two boundaries (section 3) instead of one plane: hermiteRatio() between them in
    /// the regions of the joint and of the one above.
    ///
    /// \param joint index in `joints`
    /// \param upper where the upper boundary crosses the bone, from the joint's centre, in units of
    ///        the bone's length
    /// \param lower the same of the lower boundary
    /// \return one value for each welded vertex
    std::vector<double> bounded(std::size_t joint, double upper, double lower) const;

private:
    std::vector<double> subtree(std::size_t joint) const;
    std::vector<double> cut(std::size_t joint, double shift) const;
};

/// R_j for each joint: the radius of the limb at the joint. This is the median distance to the
/// bone's line of the edges that BinaryField::divided() cuts; 0 for joints without skin.
std::vector<double> limbRadii(const BinaryField& binary);

/// True for a bone outside the trunk that is long for its radius: upper arm, forearm, thigh, shin.
bool isLimb(const PlannedJoint& joint, double radius);

} // namespace osgSkin

#endif
