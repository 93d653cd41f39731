// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowPose.h"

#include <glm/vec3.hpp>

#include <iosfwd>
#include <vector>

namespace mannequin {

/// Angles of the BVH channels Zrotation Yrotation Xrotation: R = Rz Ry Rx, degrees.
struct EulerZyx {
    double z = 0, y = 0, x = 0;
};

/// The angles of a rotation nearest to `previous`, so that a curve of them is continuous.
EulerZyx eulerNear(const glm::dquat& rotation, const EulerZyx& previous);

/// A motion as BVH writes it: one row a frame, the root's position and then the joints' angles.
using BvhRow = std::vector<double>;

/// The rows of a sequence of poses.
std::vector<BvhRow> bvhRows(const std::vector<Pose>& poses);

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

/// The pose of a row that bvhRows() made.
Pose poseOfRow(const BvhRow& row);

} // namespace mannequin
