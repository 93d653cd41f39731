// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FASTTARGETS_H
#define OSGSKINBIND_FASTTARGETS_H

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace osgSkin {

/// A bent joint as closed-form targets see it. All from the joint's centre, in the space of the
/// bone above at rest.
struct FoldShape {
    glm::dvec3 above;    ///< a: unit, direction in which the bone above arrives
    glm::dvec3 boneRest; ///< b0: unit, the bone at rest
    glm::dvec3 bone;     ///< b: unit, where the bend has put it
    double radius;       ///< of the limb
    double angle;        ///< between a and b, degrees: 0 is straight
    double angleAtRest;  ///< between a and b0
    /// Unit normal of the plane in which both sides meet, towards the child's: the bisecting plane,
    /// or one that leaves more room to the side with more flesh.
    glm::dvec3 normal;
};

/// No balloon: takes a vertex back to the distance from its posed bone that it had at rest, and
/// leaves one that has come nearer.
glm::dvec3 clampBulge(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed);

/// Moves a vertex across its bone to where it would be if the bone's bend took it along rigidly; it
/// keeps its position along the bone. Plain skin lags behind the bone: it leaves the inner side and
/// balloons on the outer one, so this restores the sections beside the joint. Skin of the inner
/// side stops short of the plane in which both sides meet.
/// \param clamped of clampBulge()
/// \param turn the whole bend, with the vertex's own share of the twist
glm::dvec3 restoreSection(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& clamped,
                          const glm::dquat& turn);

/// How far a vertex lies on the inner side of its bone, in radii.
double depthIn(const FoldShape& fold, const glm::dvec3& posed);

/// Moves a vertex sideways, parallel to the axis that the joint folds about, by a share of its
/// distance from the bone. The flanks and the inner side widen; the outer side keeps its shape.
/// \param most the vertex's distance from the bone afterwards, over that at rest, at most; a vertex
///        that is farther away already stays
glm::dvec3 widen(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed,
                 double share, double most);

/// How much a vertex belongs to the child's side of the joint, 0 to 1.
double childShare(const FoldShape& fold, const glm::dvec3& rest);

/// No fold through itself: keeps a vertex on its own side of the plane in which both meet, the
/// skin of both sides pressed flat against it.
glm::dvec3 pressFold(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed);

} // namespace osgSkin

#endif
