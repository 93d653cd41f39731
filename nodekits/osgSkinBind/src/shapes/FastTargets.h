// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FASTTARGETS_H
#define OSGSKINBIND_FASTTARGETS_H

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
};

/// No balloon: takes a vertex back to the distance from its posed bone that it had at rest, and
/// leaves one that has come nearer.
glm::dvec3 clampBulge(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed);

/// How far a vertex lies on the inner side of its bone, in radii.
double depthIn(const FoldShape& fold, const glm::dvec3& posed);

/// Swells the flanks and the inner side by a share of their distance from the bone; the outer side
/// keeps its own.
glm::dvec3 swell(const FoldShape& fold, const glm::dvec3& posed, double share);

/// No fold through itself: keeps a vertex on its own side of the plane that bisects the joint, the
/// skin of both sides pressed flat against it.
glm::dvec3 pressFold(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed);

} // namespace osgSkin

#endif
