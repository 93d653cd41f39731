// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_FACESLIMB_H
#define OSGSKINBIND_REGIONS_FACESLIMB_H

#include "joints/JointPlan.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {

/// From how far off, in limb radii, a limb's bone has no skin that faces it.
constexpr double kFacing = 1.5;

/// True for skin that faces a limb's bone across the air, as the torso's side does an arm that
/// hangs down beside it: its own bone lies behind it.
///
/// \param limb whose bone
/// \param radius of the limb at its joint, of limbRadii()
/// \param position of a vertex, rest space
/// \param normal of the vertex, outwards
inline bool facesLimb(const PlannedJoint& limb, double radius, const glm::dvec3& position,
                      const glm::dvec3& normal) {
    const glm::dvec3 d = position - limb.centre;
    const double along = std::clamp(glm::dot(d, limb.boneAxis), 0.0, limb.boneLength);
    const glm::dvec3 off = d - along * limb.boneAxis;
    return glm::length(off) > kFacing * radius && glm::dot(normal, off) < 0.0;
}

} // namespace osgSkin

#endif
