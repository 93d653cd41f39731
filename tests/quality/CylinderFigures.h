// SPDX-License-Identifier: MIT
#ifndef QUALITY_CYLINDERFIGURES_H
#define QUALITY_CYLINDERFIGURES_H

#include "Subject.h"

#include <nlohmann/json.hpp>

#include <ostream>
#include <vector>

namespace quality {

/// The upper half of a cylinder of radius 1 and length 8, rotated against the lower half; degrees.
struct CylinderPose {
    double bend = 0.0, twist = 0.0;
    PerMethod<double> strain;    ///< edge strain RMS
    PerMethod<double> volume;    ///< V'/V
    PerMethod<double> leastArea; ///< of its rings, A'/A
};

/// Twists of 30 to 330 degrees, then bends of 30 to 150. The peers' weights are smooth over one
/// radius on either side of the joint.
std::vector<CylinderPose> measureCylinder();

/// Area kept in every twist, volume kept in bends of up to 120 degrees: the figures with limits.
double leastTwistArea(const std::vector<CylinderPose>& poses);
double mostVolumeError(const std::vector<CylinderPose>& poses);

/// Prints the cylinder's figures as a table, and as JSON.
void printTable(const std::vector<CylinderPose>& poses, std::ostream& out);
nlohmann::ordered_json toJson(const std::vector<CylinderPose>& poses);

} // namespace quality

#endif
