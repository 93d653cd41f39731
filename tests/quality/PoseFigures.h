// SPDX-License-Identifier: MIT
#pragma once

#include "Methods.h"
#include "NormalError.h"
#include "PoseSet.h"

namespace quality {

/// What one pose does to the skin.
struct PoseFigure {
    std::string name;
    compare::EdgeStrain strain;
    double volumeError = 0.0; ///< abs(V'/V - 1)
    NormalError normals;
    double bulge = 0.0;            ///< see LimbBulge
    std::size_t intersections = 0; ///< pairs of triangles, beyond those at rest
};

/// What a set of poses does to it.
struct PoseFigures {
    double strain = 0.0;        ///< edge strain RMS, mean over the poses
    double percentile999 = 0.0; ///< 99.9th percentile of l'/l, mean over the poses
    double longest = 0.0;       ///< largest l'/l of any edge in any pose
    std::string longestIn;      ///< that pose's name
    double volumeError = 0.0;   ///< mean over the poses
    NormalError normals;        ///< mean over the poses
    double bulge = 0.0;         ///< mean over the poses
    double intersections = 0.0; ///< pairs of triangles beyond those at rest, mean over the poses
    std::vector<PoseFigure> poses;
};

/// Ours alone, and of each pose only strain and volume.
PoseFigures measureOurs(const Subject& subject, const std::vector<NamedPose>& poses);

/// All methods, and of each pose only strain and volume.
PerMethod<PoseFigures> measureStrains(const Subject& subject, const std::vector<NamedPose>& poses);

PerMethod<PoseFigures> measurePoses(const Subject& subject, const std::vector<NamedPose>& poses);

} // namespace quality
