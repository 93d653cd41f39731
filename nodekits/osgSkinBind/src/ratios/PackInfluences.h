// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_PACKINFLUENCES_H
#define OSGSKINBIND_PACKINFLUENCES_H

#include "joints/JointPlan.h"
#include "ratios/JointFields.h"

#include <osgSkin/Binding>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// One vertex's influences out of the fields, in joint order, at most `mostPartial` of them
/// partial. Returns whether there were more.
///
/// Where there were, all ratios are stretched by as much as rounds the fifth to 0 or 1. That is as
/// continuous over the skin as the fields are (rounding the extra ones alone would tear it), and
/// keeps each joint's ratios below its parent's.
bool packInfluences(const std::vector<PlannedJoint>& joints, const JointFields& bend,
                    const JointFields& twist, std::size_t vertex, std::size_t mostPartial,
                    std::vector<Influence>& influences);

bool isPartial(const Influence& influence);

} // namespace osgSkin

#endif
