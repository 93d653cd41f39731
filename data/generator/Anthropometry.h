// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "SkinMesh.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace mannequin {

/// A girth or breadth of the body and its published mean.
struct BodyMeasure {
    std::string name;
    double published; ///< metres, scaled to the mannequin's stature
    double achieved;
};

/// Measures the skin as a tape or calliper would, on the convex hulls of cross-sections.
///
/// The published values are means for men (stature 1.756 m), rounded to the centimetre: C. C.
/// Gordon et al., *1988 Anthropometric Survey of U.S. Army Personnel: Methods and Summary
/// Statistics*, NATICK/TR-89/044 (1989), scaled here by 1.80 / 1.756.
std::vector<BodyMeasure> measureBody(const SkinMesh& mesh);

void printMeasures(std::ostream& out, const std::vector<BodyMeasure>& measures);

} // namespace mannequin
