// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowPose.h"

#include <vector>

namespace mannequin {

/// Angles of the BVH channels Zrotation Yrotation Xrotation: R = Rz Ry Rx, degrees.
struct EulerZyx {
    double z = 0, y = 0, x = 0;
};

/// The Euler angles of a rotation that are closest to `previous`, to make continuous curves.
EulerZyx eulerNear(const glm::dquat& rotation, const EulerZyx& previous);

/// One frame of a BVH motion: the root's position, then the joints' angles.
using BvhRow = std::vector<double>;

/// The rows of a sequence of poses.
std::vector<BvhRow> bvhRows(const std::vector<Pose>& poses);

/// The pose of a row made by bvhRows().
Pose poseOfRow(const BvhRow& row);

} // namespace mannequin
