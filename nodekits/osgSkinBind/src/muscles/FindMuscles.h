// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FINDMUSCLES_H
#define OSGSKINBIND_FINDMUSCLES_H

#include "joints/JointPlan.h"
#include "muscles/Muscle.h"

#include <osgSkin/Binding>

#include <string>
#include <vector>

namespace osgSkin {

/// The muscles that options ask for: biceps and triceps, quadriceps and hamstrings, and calves,
/// where the joints' names tell arms and legs, and the author's own.
/// \param bound the binding's joints
/// \param notes gets a line for each that cannot be made
/// \throw osgSkin::Error where an own muscle names a joint that is not there, that bends in no
///        direction that is known, or has no bone above it
std::vector<Muscle> findMuscles(const RestSkeleton& skeleton,
                                const std::vector<PlannedJoint>& joints,
                                const std::vector<BoundJoint>& bound, const BindOptions& options,
                                std::vector<std::string>& notes);

} // namespace osgSkin

#endif
