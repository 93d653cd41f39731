// SPDX-License-Identifier: MIT
#pragma once

#include "BvhEuler.h"
#include "ThrowPose.h"

#include <iosfwd>
#include <vector>

namespace mannequin {

/// The skeleton at rest: the root's OFFSET is its rest position, one frame of zeros.
void writeRig(std::ostream& out, const Skeleton& skeleton);

/// The skeleton moving. The root's OFFSET is zero and its channels hold its world position: readers
/// differ in whether the channel adds to the offset or replaces it.
void writeMotion(std::ostream& out, const Skeleton& skeleton, const std::vector<BvhRow>& rows);

/// A single joint named "ball" moving.
void writeBall(std::ostream& out, const std::vector<BvhRow>& rows);

/// The rows of a BVH text's MOTION section.
/// \throw std::runtime_error when there is none or a number is missing
std::vector<BvhRow> readRows(std::istream& in);

} // namespace mannequin
