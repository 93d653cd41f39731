// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_JOINTPLAN_H
#define OSGSKINBIND_JOINTPLAN_H

#include "mesh/WeldedMesh.h"

#include <osgSkinBind/BindOptions>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <cstdint>
#include <string>
#include <vector>

namespace osgSkin {

/// Joint centres closer than this fraction of the mesh's size are one point.
constexpr double kCentreTolerance = 1e-6;

/// What binding decides about one joint before it looks at regions.
struct PlannedJoint {
    glm::dvec3 centre{0.0};
    glm::dvec3 boneEnd{0.0};  ///< the child's centre or the tip; the centre where there is neither
    glm::dvec3 boneAxis{0.0}; ///< unit
    double boneLength = 0.0;  ///< from the centre to boneEnd
    glm::dvec3 comingFrom{0.0}; ///< unit; direction in which the bone above arrives
    double lengthAbove = 0.0;   ///< of that bone; 0 for the root
    glm::dvec3 twistAxis{0.0};  ///< unit; the pole, w of eq. 1
    double poleLength = 0.0;    ///< length of the bone that the twist builds up along
    bool poleIsParent = false;

    JointPart part = JointPart::Other; ///< of the body, by its name
    int parent = -1;
    int child = -1;         ///< the child that continues the chain, -1 for a leaf
    int rigid = -1;         ///< the rigid joint at or above, -1 where there is none
    bool extremity = false; ///< a topmost head, hand or foot
    bool digit = false;     ///< below an extremity that is not rigid: of a finger or a toe
    bool topmost =
        false;          ///< moves all skin, with no region above it: hips below a root on the floor
    bool trunk = false; ///< of the trunk: spine, hips, collar bones
    bool collarBone = false;  ///< between the spine and an upper arm
    double armDistance = 0.0; ///< of a collar bone's joint from the upper arm's
    bool helper = false;  ///< stands in another joint's place, or below one that does: owns nothing
    bool inside = false;  ///< the centre is inside the skin
    bool outside = false; ///< the centre is not, and the joint is no part of a hand or a head
    bool claims = false;  ///< outside the skin: takes the skin nearest to it
    bool holdsRegion = false; ///< has a region, so its field is its own; else its children's

    /// The points that stand for the joint in the Delaunay step, inside the skin.
    std::vector<glm::dvec3> samples;
    /// Sorted welded vertices beyond the joint, which follow it wholly: of a head, hand or foot,
    /// see findExtremities(). Empty where its region has no such border.
    std::vector<std::uint32_t> beyond;

    JointBindOptions options; ///< what the author said about it

    /// Of the trunk, and no collar bone.
    bool isSpine() const { return trunk && !collarBone; }
    bool belowRigid(int index) const { return rigid >= 0 && rigid != index; }
};

/// Unit normal of the joint's plane, towards the child. It bisects the bone above and its own;
/// along the trunk, whose bones go to and fro, the longer of the two counts more.
glm::dvec3 planeNormal(const PlannedJoint& joint);

/// Distance of a point, rest space, to the joint's bone, which may have no length.
double distanceToBone(const PlannedJoint& joint, const glm::dvec3& point);

/// For each joint whether it is `joint` itself or below it in the tree.
std::vector<bool> subtreeOf(const std::vector<PlannedJoint>& joints, std::size_t joint);

/// The nearest joint above that has a region; the root where none has.
std::size_t regionAbove(const std::vector<PlannedJoint>& joints, std::size_t joint);

/// Axes, poles and roles of the joints, in the skeleton's order.
///
/// \param skeleton valid
/// \param mesh tells which joints are inside the skin, and how large a body is
/// \param options checked
/// \param notes gets a line for each thing that is unusual: joints outside the skin, ...
/// \throw osgSkin::Error where an option names a joint that is not there
std::vector<PlannedJoint> planJoints(const RestSkeleton& skeleton, const WeldedMesh& mesh,
                                     const BindOptions& options, std::vector<std::string>& notes);

} // namespace osgSkin

#endif
