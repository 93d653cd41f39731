// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SHAPEDJOINT_H
#define OSGSKINBIND_SHAPEDJOINT_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"
#include "shapes/ShapeReach.h"

#include <osgSkin/BendTwist>
#include <osgSkin/Binding>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace osgSkin {

/// A joint between two limbs, or of a limb at the trunk, whose skin correctives can shape, with the
/// skin around it. Rest space; vertices are welded ones.
struct ShapedJoint {
    /// Joint, basis (Ball: a shoulder or a hip), main axis, range and knots; not yet modes and
    /// coefficients.
    CorrectiveJoint functions;
    glm::dvec3 centre{0.0};
    glm::dvec3 twistAxis{0.0}; ///< w
    glm::dvec3 above{0.0};     ///< unit; direction in which the bone above arrives; at the trunk,
                               ///< `bone`
    glm::dvec3 bone{0.0};      ///< unit; from the centre to the child
    glm::dvec3 hinge{0.0};     ///< unit; axis that the bone turns about where there is a main one.
                               ///< It need not be perpendicular to the bone: such bends twist, too
    double radius = 0.0;       ///< of the limb at the joint
    glm::dvec3 away{0.0};      ///< unit, or 0 without a pit; see ShapePit

    /// A vertex within the joint's reach.
    struct Vertex {
        std::uint32_t index;
        glm::dvec3 from; ///< the centre, at rest
        double bend;     ///< ratios of this joint
        double twist;
        double limb; ///< how much the skin is of the limb above: bend ratio of the joint above; 1
                     ///< where that is the root. At the trunk, how much it is of the limb itself
        double fade; ///< what of its target it takes: 1, and 0 towards the reach's end
        double fadeClosed; ///< the same where the pit is closed, see pitClosedAt()
    };
    std::vector<Vertex> vertices;

    /// Those with a corner within reach; three indices in `vertices` each, which for that has
    /// vertices beyond the reach, too, with `fade` 0. They look outwards.
    std::vector<std::array<std::uint32_t, 3>> triangles;

    /// True where the bone above is none of a limb's: at shoulders and hips.
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

    /// How far a bend closes the pit between limb and trunk, 0 to 1: an arm's that hangs at the
    /// side, or lies in front of the chest, by far, that of a raised one not.
    double pitClosedAt(const BendTwist& bend) const;

    /// What a bend does to a vertex at its own ratios, from the joint's centre to there.
    glm::dquat turnOf(const Vertex& vertex, const BendTwist& bend) const {
        return partialRotation(bend, twistAxis, vertex.bend, vertex.twist);
    }
};

/// How far joints are shaped.
struct ShapeScope {
    ShapeReach betweenLimbs{4.5, 6.0};
    ShapeReach atTrunk{4.5, 6.0};
    ShapeReach besideLimb{4.5, 6.0}; ///< at the trunk, where the next limb begins beside it: hips
    ShapeReach inPit{4.5, 6.0};      ///< at the trunk elsewhere, in a closed pit: armpits
    bool trunkToo = false;           ///< at the trunk its own skin is shaped like the limb's
    double mostFlexion = 155.0;      ///< degrees from the straight limb
    double knotStep = 30.0;          ///< degrees between a hinge's knots, at most
    double mostSwing = 130.0;        ///< of ball joints, degrees from the rest pose
};

/// Finds the joints to shape: by the shape of their limbs, and where the way they bend is not
/// plain from that, by names and the way feet point.
/// \param binding of the mesh as given, whose vertices `mesh` has welded
/// \param scope how far
std::vector<ShapedJoint> findShapedJoints(const RestSkeleton& skeleton,
                                          const std::vector<PlannedJoint>& joints,
                                          const WeldedMesh& mesh, const Binding& binding,
                                          const ShapeScope& scope = {});

} // namespace osgSkin

#endif
