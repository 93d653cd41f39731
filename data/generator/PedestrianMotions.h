// SPDX-License-Identifier: MIT
#pragma once

#include "BvhEuler.h"
#include "Gait.h"

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace mannequin {

/// A motion of the pedestrian: one cycle. Its last sample is the first one, moved by the stride.
struct PedestrianMotion {
    std::string name;
    int frameRate; ///< samples per second
    int frames;    ///< samples less one
    double stride; ///< metres towards +Z
    bool isRun;    ///< both feet leave the floor
    std::function<Pose(double seconds)> poseAt;

    std::vector<BvhRow> rows() const;
};

/// Idle, walk, run and wave.
/// \param skeleton must outlive the motions
std::vector<PedestrianMotion> pedestrianMotions(const Skeleton& skeleton);

/// Prints properties of a motion's rows, with the bounds that they must keep: the loop, the feet on
/// the floor, the knees. Returns whether all are kept.
bool checkMotion(std::ostream& out, const Skeleton& skeleton, const PedestrianMotion& motion,
                 const std::vector<BvhRow>& rows);

} // namespace mannequin
