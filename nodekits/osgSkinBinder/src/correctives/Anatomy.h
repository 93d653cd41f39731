// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_ANATOMY_H
#define OSGSKINBINDER_CORRECTIVES_ANATOMY_H

#include "correctives/ShapedJoint.h"
#include "correctives/SkinRelaxation.h"
#include "garments/SkinLayers.h"

#include <osgSkinRig/JointRoles>

namespace osgSkin {

/// Adds what the tissue below the skin of people's knees, elbows, shoulders, hips and necks does as
/// the joint bends (ShapedJoint::tissues). Joints without such a role, and limbs that are short for
/// their radius, get less or nothing.
/// \param roles of the skeleton's joints
/// \param layers the shells that lie on others, which move with the skin below; may be null
/// \param shaped of findShapedJoints() or findSoftJoints()
void addTissues(const JointRoles& roles, const std::vector<PlannedJoint>& joints,
                const WeldedMesh& mesh, const SkinLayers* layers, ShapedJoint& shaped);

/// The rest skin of a joint, displaced by its tissues as they are at a bend. The posed displacement
/// is smoothed, since normals converge in creases.
/// \param skin of the joint's vertices, relative to its centre
/// \param relaxation of the joint
std::vector<glm::dvec3> displacedByTissues(const ShapedJoint& joint, std::vector<glm::dvec3> skin,
                                           const BendTwist& bend, const SkinRelaxation& relaxation);

} // namespace osgSkin

#endif
