// SPDX-License-Identifier: MIT
#pragma once

#include "BvhEuler.h"
#include "ThrowPose.h"
#include "ThrowTiming.h"

#include <iosfwd>
#include <vector>

namespace mannequin {

/// How the numbers of a motion are written.
struct MotionFormat {
    int frameRate = kFrameRate; ///< frames per second
    int decimals = 6;
};

/// Writes the skeleton at rest: the root's OFFSET is its rest position; one frame of zeros.
void writeRig(std::ostream& out, const Skeleton& skeleton);

/// Writes a motion of the skeleton. The root's OFFSET is zero and its channels contain its world
/// position, because some readers add the channels to the offset and others replace it.
void writeMotion(std::ostream& out, const Skeleton& skeleton, const std::vector<BvhRow>& rows,
                 const MotionFormat& format = {});

/// Writes a motion of a single joint named "ball".
void writeBall(std::ostream& out, const std::vector<BvhRow>& rows);

/// Reads the rows of a BVH file's MOTION section.
/// \throw std::runtime_error if the section or a number is missing
std::vector<BvhRow> readRows(std::istream& in);

} // namespace mannequin
