// SPDX-License-Identifier: MIT
#ifndef QUALITY_POSEFIGURES_H
#define QUALITY_POSEFIGURES_H

#include "SkinFigures.h"
#include "Subject.h"

#include <string>

namespace quality {

/// The effect of one pose on the skin.
struct PoseFigure {
    std::string name;
    compare::EdgeStrain strain;
    double volumeError = 0.0; ///< abs(V'/V - 1)
    NormalError normals;
    double bulge = 0.0;            ///< see LimbBulge
    std::size_t intersections = 0; ///< pairs of triangles, beyond those at rest
};

/// The effect of a set of poses on the skin.
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

/// Ours alone, with only strain and volume of each pose.
PoseFigures measureOurs(const Subject& subject, const std::vector<NamedPose>& poses);

/// All methods, with only strain and volume of each pose.
PerMethod<PoseFigures> measureStrains(const Subject& subject, const std::vector<NamedPose>& poses);

PerMethod<PoseFigures> measurePoses(const Subject& subject, const std::vector<NamedPose>& poses);

/// Each hand twisted about its pole; the worse of the two.
struct WristTwist {
    double degrees = 0.0;
    PerMethod<double> strain;                  ///< RMS over the edges that change their length
    PerMethod<CrossSections::Least> leastArea; ///< of the forearm's cross-sections
};

/// At 60, 120 and 170 degrees. Empty if the rig has no hands.
std::vector<WristTwist> measureWristTwists(const Subject& subject);

/// The cost of limiting how many joints a vertex follows in part: the largest share by which any
/// figure of the motions or of a twisted wrist is worse than without the limit.
struct CappingCost {
    double share = 0.0;
    std::string figure; ///< the figure it applies to
};

/// `capped` and `wrist` are the subject's own figures.
CappingCost measureCapping(const Subject& subject, const std::vector<NamedPose>& poses,
                           const PoseFigures& capped, const std::vector<WristTwist>& wrist);

} // namespace quality

#endif
