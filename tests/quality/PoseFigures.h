// SPDX-License-Identifier: MIT
#pragma once

#include "Methods.h"
#include "PoseSet.h"

namespace quality {

/// What one pose does to the skin.
struct PoseFigure {
    std::string name;
    compare::EdgeStrain strain;
    double volumeError = 0.0; ///< abs(V'/V - 1)
};

/// What a set of poses does to it.
struct PoseFigures {
    double strain = 0.0;        ///< edge strain RMS, mean over the poses
    double percentile999 = 0.0; ///< 99.9th percentile of l'/l, mean over the poses
    double longest = 0.0;       ///< largest l'/l of any edge in any pose
    std::string longestIn;      ///< that pose's name
    double volumeError = 0.0;   ///< mean over the poses
    std::vector<PoseFigure> poses;
};

PerMethod<PoseFigures> measurePoses(const Subject& subject, const std::vector<NamedPose>& poses);

} // namespace quality
