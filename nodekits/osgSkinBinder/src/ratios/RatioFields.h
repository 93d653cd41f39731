// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_RATIOS_RATIOFIELDS_H
#define OSGSKINBINDER_RATIOS_RATIOFIELDS_H

#include "ratios/JointFields.h"
#include "regions/BinaryField.h"
#include "regions/HermiteRatio.h"

#include <osgSkinBind/BindOptions>
#include <osgSkinRig/RestSkeleton>

#include <optional>
#include <vector>

namespace osgSkin {

/// Bend ratios, continuous over the skin (paper, section 3): 1 at the root, exactly 0 and 1 beyond
/// a joint's bend region, never more than the parent's.
///
/// \param binary the fields' start
/// \param radii of limbRadii()
/// \param options uses smoothing and cutOff
/// \param skeleton has the joints' names, for the progress
/// \param progress called from the calling thread after each joint's field; may throw to give up
JointFields bendFields(const BinaryField& binary, const std::vector<double>& radii,
                       const BindOptions& options, const RestSkeleton& skeleton,
                       const Progress& progress);

/// The relative slope of a field: how many times steeper it is at each vertex than on average.
///
/// A field that is only diffused concentrates its slope in concave skin such as the armpit and the
/// crotch, where the path from limb to trunk is shortest, and that skin is strained most. If the
/// field is spread wider there by this factor, it is almost equally steep everywhere.
///
/// \param mesh the skin
/// \param field one value for each welded vertex, 0 to 1
/// \return for each welded vertex a factor of at least 1: the slope there, mean of the vertex and
///         its neighbours, over the root mean square of the slope where the field is between 0
///         and 1
std::vector<double> gradientFactor(const WeldedMesh& mesh, const std::vector<double>& field);

/// Where a joint's twist builds up with the method `smooth`; unset if the twist follows the bend.
///
/// \param joint the twisting joint
/// \param radius of the limb at the joint, of limbRadii()
std::optional<BoundarySpan> twistSpan(const PlannedJoint& joint, double radius);

/// Twist ratios. They build up along the pole bone, within the bend field of the joint that moves
/// that bone, so they are as continuous as the bend fields. Never more than the parent's.
///
/// \param mesh the skin
/// \param joints of planJoints()
/// \param radii of limbRadii()
/// \param bend of bendFields()
JointFields twistFields(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                        const std::vector<double>& radii, const JointFields& bend);

} // namespace osgSkin

#endif
