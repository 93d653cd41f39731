// SPDX-License-Identifier: MIT
#ifndef OSGSKINBIND_JOINTS_JOINTPLAN_H
#define OSGSKINBIND_JOINTS_JOINTPLAN_H

#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>
#include <osgSkinBind/BindOptions>
#include <osgSkinBind/Export>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// Joint centres closer than this fraction of the mesh's size are one point.
constexpr double kCentreTolerance = 1e-6;

enum class JointKind {
    Limb,       ///< of an arm, a leg, a neck, a tail
    Spine,      ///< of the trunk: spine, hips
    CollarBone, ///< of the trunk, between the spine and an upper arm
    Extremity,  ///< a topmost head, hand or foot
    Digit,      ///< of a finger or toe: below an extremity that is not rigid
};

/// Which skin is a joint's region, and so gets a field of its own.
enum class RegionSource {
    None,    ///< no region: its skin is that of its children or of the region above
    Helper,  ///< none, as it is at or below another joint's point
    Bones,   ///< the skin around its bones, by the Delaunay step
    Nearest, ///< outside the skin: the nearest skin
};

/// A joint's role and bone, as binding plans them before it finds regions.
struct PlannedJoint {
    glm::dvec3 centre{0.0};
    glm::dvec3 boneEnd{0.0};    ///< the child's centre or the tip; the centre if there is neither
    glm::dvec3 boneAxis{0.0};   ///< unit
    double boneLength = 0.0;    ///< from the centre to boneEnd
    glm::dvec3 comingFrom{0.0}; ///< unit; direction in which the bone above arrives
    double lengthAbove = 0.0;   ///< of that bone; 0 for the root
    glm::dvec3 twistAxis{0.0};  ///< unit; the pole, w of eq. 1
    double poleLength = 0.0;    ///< length of the bone along which the twist builds up
    bool poleIsParent = false;

    JointPart part = JointPart::Other; ///< by its name
    int parent = -1;
    int child = -1; ///< the child that continues the chain, -1 for a leaf
    int rigid = -1; ///< the rigid joint at or above, or -1
    JointKind kind = JointKind::Limb;
    RegionSource region = RegionSource::None;
    bool topmost = false; ///< moves all skin: no region above it, as hips below a root on the floor
    double armDistance = 0.0; ///< from a collar bone's joint to the upper arm's
    /// Whether the centre is inside the skin; not set for a joint that has no region in any skin.
    std::optional<bool> inside;

    /// The points of the joint in the Delaunay step, inside the skin.
    std::vector<glm::dvec3> samples;
    /// Sorted welded vertices beyond a head, hand or foot, which follow the joint fully; see
    /// findExtremities(). May be empty.
    std::vector<std::uint32_t> beyond;

    JointBindOptions options; ///< by the author

    bool isSpine() const { return kind == JointKind::Spine; }
    bool isCollarBone() const { return kind == JointKind::CollarBone; }
    bool isOfTrunk() const { return isSpine() || isCollarBone(); }
    bool isExtremity() const { return kind == JointKind::Extremity; }
    bool isDigit() const { return kind == JointKind::Digit; }
    bool holdsRegion() const {
        return region == RegionSource::Bones || region == RegionSource::Nearest;
    }
    bool isInside() const { return inside.value_or(false); }
    bool isOutside(int index) const { return !inside.value_or(true) && !belowRigid(index); }
    bool belowRigid(int index) const { return rigid >= 0 && rigid != index; }
};

/// Axes, poles and parts of the joints, in the skeleton's order; regions are not set.
///
/// \param skeleton valid
/// \param mesh its size tells which centres are one point
/// \param roles of the skeleton's joints
/// \param options checked
/// \throw osgSkin::Error if an option names a joint that does not exist
OSGSKINBIND_EXPORT std::vector<PlannedJoint> planAxes(const RestSkeleton& skeleton,
                                                      const WeldedMesh& mesh,
                                                      const JointRoles& roles,
                                                      const BindOptions& options);

/// The joints for the deformation, in the skeleton's order.
OSGSKINBIND_EXPORT std::vector<BoundJoint> boundJoints(const RestSkeleton& skeleton,
                                                       const std::vector<PlannedJoint>& joints);

} // namespace osgSkin

#endif
