// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowPose.h"

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

/// The pose of a row that bvhRows() made.
Pose poseOfRow(const BvhRow& row);

} // namespace mannequin
