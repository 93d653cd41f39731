// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_PACKINFLUENCES_H
#define OSGSKINBIND_PACKINFLUENCES_H

#include "joints/JointPlan.h"
#include "ratios/JointFields.h"

#include <osgSkin/Binding>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Adds one vertex's influences out of the fields, in joint order, at most `mostPartial` of them
/// fractional (Influence::isFractional()).
///
/// Where there were more, all ratios are stretched by as much as rounds the surplus ones to 0 or 1.
/// That is as continuous over the skin as the fields are (rounding the extra ones alone would tear
/// it), and keeps each joint's ratios at most its parent's.
///
/// \param joints of planJoints()
/// \param bend ratios of each joint
/// \param twist ratios of each joint
/// \param vertex index in the fields
/// \param mostPartial how many influences may be fractional
/// \param influences what is found is added at its end
/// \return whether there were more
bool packInfluences(const std::vector<PlannedJoint>& joints, const JointFields& bend,
                    const JointFields& twist, std::size_t vertex, std::size_t mostPartial,
                    std::vector<Influence>& influences);

} // namespace osgSkin

#endif
