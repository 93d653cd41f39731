// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_SHAPEDJOINT_H
#define OSGSKINBINDER_CORRECTIVES_SHAPEDJOINT_H

#include "joints/JointRegions.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/BendTwist>
#include <osgSkin/Binding>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

namespace osgSkin {

class CoarseGraph;

/// How far from a joint its skin is shaped, in radii of the limb.
struct ShapeReach {
    double whole; ///< nearer skin is moved wholly to its target
    double end;   ///< farther skin is not moved

    /// The share of its target that skin takes, 1 to 0, falling smoothly.
    double shareAt(double radii) const;
};

/// A joint between two limbs, or between a limb and the trunk, that correctives can shape, with the
/// skin around it. Rest space; vertices are welded ones.
struct ShapedJoint {
    /// Joint, basis (Ball: a shoulder or a hip), main axis, range and knots; not yet modes and
    /// coefficients.
    CorrectiveJoint functions;
    glm::dvec3 centre{0.0};
    glm::dvec3 twistAxis{0.0}; ///< w
    glm::dvec3 above{0.0};     ///< unit; direction of the bone above; at the trunk that of `bone`
    glm::dvec3 bone{0.0};      ///< unit; from the centre to the child
    glm::dvec3 hinge{0.0};     ///< unit; findHinge() if there is a main axis. If it is not
                               ///< perpendicular to the bone, bends twist, too
    double radius = 0.0;       ///< of the limb at the joint
    /// How far skin halfway between the bones moves along with the bent bone, in radii, for each
    /// unit by which the bone's direction changes. Captured people's skin does; a rotation about
    /// the joint leaves it behind.
    double slide = 0.0;
    double relaxation = 0.0; ///< how far the posed skin is smoothed, in radii; see SkinRelaxation
    /// Neither a joint between two limbs nor one between a limb and the trunk: its skin slides and
    /// is smoothed all over, and has no other shape.
    bool isSoft = false;

    /// A vertex within the joint's reach.
    struct Vertex {
        std::uint32_t index;
        glm::dvec3 from; ///< rest position relative to the centre
        double bend;     ///< ratios of this joint
        double twist;
        double
            limb; ///< how much it belongs to the limb above: the bend ratio of the joint above, or
                  ///< 1 if that is the root. At the trunk, how much it belongs to the limb itself
        double fade; ///< the share of its target that it takes
    };
    std::vector<Vertex> vertices;

    /// The triangles with a corner within reach, facing outwards: three indices in `vertices` each.
    /// Their corners beyond the reach are in `vertices`, too, with `fade` 0.
    std::vector<std::array<std::uint32_t, 3>> triangles;

    /// How far from a joint its tissue reaches, in radii.
    static constexpr double kTissueReach = 2.6;

    /// Tissue below the skin that displaces it as the joint bends, before all other shapes.
    struct Tissue {
        std::function<double(const BendTwist&)> amount; ///< 0 at rest
        std::vector<glm::dvec3> moves; ///< of each vertex by an amount of 1, rest space
    };
    std::vector<Tissue> tissues; ///< see addTissues()

    /// True if the bone above belongs to no limb: at shoulders and hips.
    bool isAtTrunk() const { return functions.basis == CorrectiveJoint::Basis::Ball; }

    /// The bend at coordinates (x, y) of CorrectiveJoint.
    BendTwist bendAt(const glm::dvec2& xy) const {
        const double sine = glm::length(xy);
        const glm::dvec3 other = glm::cross(twistAxis, functions.axis);
        BendTwist bend;
        bend.bendAxis = sine > 0.0 ? (xy.x * functions.axis + xy.y * other) / sine : functions.axis;
        bend.bendAngle = 2.0 * std::asin(std::min(sine, 1.0));
        return bend;
    }

    /// turnOf() each vertex.
    std::vector<glm::dquat> turnsOf(const BendTwist& bend) const;

    /// The rotation of a vertex about the joint's centre, by its own ratios of a bend.
    glm::dquat turnOf(const Vertex& vertex, const BendTwist& bend) const {
        return partialRotation(bend, twistAxis, vertex.bend, vertex.twist);
    }
};

/// Finds the joints to shape by the shape of their limbs, without those of twist bones. The
/// directions in which they bend come from the rest pose or, if that does not show them, from names
/// and the direction of the feet.
/// \param binding of the mesh before welding
std::vector<ShapedJoint> findShapedJoints(const RestSkeleton& skeleton,
                                          const std::vector<PlannedJoint>& joints,
                                          const WeldedMesh& mesh, const Binding& binding);

/// Finds the joints whose skin only slides and is smoothed (ShapedJoint::isSoft): necks, collar
/// bones, wrists and ankles.
/// \param binding of the mesh before welding
std::vector<ShapedJoint> findSoftJoints(const std::vector<PlannedJoint>& joints,
                                        const WeldedMesh& mesh, const Binding& binding);

/// The joint on a coarser copy of its skin, with an index in the copy for each vertex.
ShapedJoint coarserJoint(const ShapedJoint& joint, const CoarseGraph& coarser);

/// Sets basis, axis, range and knots of a joint's functions.
/// \param mainAxis of findMainAxis(); a joint without one bends in any direction
/// \param across the x axis of a joint that bends in any direction. It is a direction of the body, so
///        that a rotated or mirrored body has the same shapes; may be along the twist axis
/// \param joint above, bone and twistAxis are set
/// \param mostFlexion degrees from the straight limb
void setBendRange(const std::optional<glm::dvec3>& mainAxis, const glm::dvec3& across,
                  ShapedJoint& joint, double mostFlexion = 155.0);

/// The same for a joint at the trunk, which bends in all directions.
/// \param across as for setBendRange()
/// \param joint twistAxis is set
/// \param mostSwing degrees from the rest pose
void setBallRange(const glm::dvec3& across, ShapedJoint& joint, double mostSwing = 130.0);

/// Lets a hinge rotate about the limb, as knees and elbows do: sets basis and range of y.
/// \param joint of setBendRange(), with a main axis
void setTurnedHinge(ShapedJoint& joint);

/// The bends of a turned hinge that shapes are fitted to, from one end of the range to the other
/// and to both sides. They twist, too, if the hinge rotates or is not perpendicular to the bone.
std::vector<BendTwist> turnedBends(const ShapedJoint& joint);

/// The bends that shapes are fitted to, as coordinates (x, y) of the joint's functions: the whole
/// range with its ends, without the rest pose.
std::vector<glm::dvec2> bendSamples(const ShapedJoint& joint);

/// The axis about which a joint between two limbs mostly bends: a rotation about it by a positive
/// angle flexes the joint. Unit, perpendicular to the joint's twist axis; not set if neither the
/// rest pose nor the joints' names show it.
///
/// A joint that is bent at rest bends further. A straight one above a hand is an elbow and bends
/// towards where the feet point; one above a foot is a knee and bends the other way.
std::optional<glm::dvec3> findMainAxis(const RestSkeleton& skeleton,
                                       const std::vector<PlannedJoint>& joints, std::size_t joint);

/// The axis in space about which a joint's bone rotates; it may be oblique to the bone. Some rigs
/// bend knees about an axis across the body, others about one across the shin: a knee's hinge lies
/// halfway between. Other joints have their main axis.
glm::dvec3 findHinge(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                     std::size_t joint, const glm::dvec3& mainAxis);

} // namespace osgSkin

#endif
