// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_ELASTICSAMPLES_H
#define OSGSKINBIND_ELASTIC_ELASTICSAMPLES_H

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// How far a hinge bends, and how it rests. Radians.
struct HingeRange {
    glm::dvec3 axis{1.0, 0.0, 0.0}; ///< unit; a turn about it by a positive angle flexes
    double restFlexion = 0.0;       ///< total flexion in the rest pose: 0 is a straight limb
    double leastFlexion = 0.0;      ///< of the anatomical range
    double mostFlexion = 0.0;
};

/// The rotations that a hinge is to be solved at: every 15 degrees or less from the rest pose to
/// both ends of its range, the ends always (without the last angle the fold comes back), and a few
/// beside the main direction, for what an elbow or knee is turned sideways.
/// \param pole unit; the bone from the joint to its child: axes beside the main one are
///        perpendicular to it, too
std::vector<glm::dquat> hingeSamples(const HingeRange& range, const glm::dvec3& pole);

/// The rotations that a ball joint is to be solved at: three angles in each of eight directions.
/// \param pole unit; the bone from the joint to its child
/// \param most radians, the largest angle
std::vector<glm::dquat> ballSamples(const glm::dvec3& pole, double most);

} // namespace osgSkin

#endif
