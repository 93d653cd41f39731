// SPDX-License-Identifier: MIT
#include "BvhEuler.h"

#include <algorithm>
#include <cmath>

namespace mannequin {
namespace {

double nearest(double angle, double previous) {
    return angle - 360 * std::round((angle - previous) / 360);
}

EulerZyx nearest(const EulerZyx& e, const EulerZyx& previous) {
    return {nearest(e.z, previous.z), nearest(e.y, previous.y), nearest(e.x, previous.x)};
}

double distance(const EulerZyx& a, const EulerZyx& b) {
    return std::hypot(a.z - b.z, a.y - b.y, a.x - b.x);
}

} // namespace

EulerZyx eulerNear(const glm::dquat& rotation, const EulerZyx& previous) {
    const glm::dmat3 m = glm::mat3_cast(rotation); // m[column][row]
    const double y = degrees(std::asin(std::clamp(-m[0][2], -1.0, 1.0)));
    if (std::hypot(m[0][0], m[0][1]) < 1e-9) {
        // Gimbal lock: only z -+ x is determined, so keep the previous z.
        const double z = previous.z;
        const double sum = degrees(std::atan2(-m[1][0], m[1][1]));
        return nearest({z, y, y > 0 ? z - sum : sum - z}, previous);
    }
    const double z = degrees(std::atan2(m[0][1], m[0][0]));
    const double x = degrees(std::atan2(m[1][2], m[2][2]));
    const EulerZyx one = nearest({z, y, x}, previous);
    const EulerZyx other = nearest({z + 180, 180 - y, x + 180}, previous);
    return distance(one, previous) <= distance(other, previous) ? one : other;
}

std::vector<BvhRow> bvhRows(const std::vector<Pose>& poses) {
    std::vector<BvhRow> rows;
    std::vector<EulerZyx> last(poses.empty() ? 0 : poses.front().local.size());
    for (const Pose& pose : poses) {
        BvhRow row{pose.root.x, pose.root.y, pose.root.z};
        for (std::size_t i = 0; i < pose.local.size(); ++i) {
            last[i] = eulerNear(pose.local[i], last[i]);
            row.insert(row.end(), {last[i].z, last[i].y, last[i].x});
        }
        rows.push_back(row);
    }
    return rows;
}

Pose poseOfRow(const BvhRow& row) {
    Pose pose;
    pose.root = {row[0], row[1], row[2]};
    for (std::size_t i = 3; i + 2 < row.size(); i += 3)
        pose.local.push_back(turn(row[i], {0, 0, 1}) * turn(row[i + 1], {0, 1, 0}) *
                             turn(row[i + 2], {1, 0, 0}));
    return pose;
}

} // namespace mannequin
