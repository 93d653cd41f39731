// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_PACKINFLUENCES_H
#define OSGSKINBIND_PACKINFLUENCES_H

#include "fields/JointRatio.h"
#include "joints/JointPlan.h"

#include <osgSkin/Binding>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Adds one vertex's influences, in joint order, at most `mostPartial` of them fractional
/// (Influence::isFractional()).
///
/// Where there were more, all ratios are stretched by as much as rounds the surplus ones to 0 or 1.
/// That is as continuous over the skin as the fields are (rounding the extra ones alone would tear
/// it), and keeps each joint's ratios at most its parent's.
///
/// \param ratios of the vertex, in joint order; those that are missing are 0
/// \param mostPartial how many influences may be fractional
/// \param influences what is found is added at its end
/// \return whether there were more
bool packInfluences(const std::vector<JointRatio>& ratios, std::size_t mostPartial,
                    std::vector<Influence>& influences);

} // namespace osgSkin

#endif
