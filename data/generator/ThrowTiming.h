// SPDX-License-Identifier: MIT
#pragma once

namespace mannequin {

constexpr int kFrameRate = 120; ///< frames in a second

/// Frames in the loop. The last shows the first pose again, both at rest.
constexpr int kFrameCount = 360;

/// Frames of the events that the literature measures at.
constexpr int kKneeUpFrame = 55;       ///< highest lift of the lead (left) knee
constexpr int kContactFrame = 108;     ///< the lead foot is flat on the floor
constexpr int kMaxExternalFrame = 121; ///< greatest external rotation of the throwing shoulder
constexpr int kReleaseFrame = 130;     ///< the ball leaves the hand
constexpr int kLeadLeavesFrame = 262;  ///< until then the ball of the lead foot stays planted

/// Time of a frame in seconds.
constexpr double frameTime(int frame) {
    return static_cast<double>(frame) / kFrameRate;
}

constexpr double loopSeconds() {
    return frameTime(kFrameCount - 1);
}

} // namespace mannequin
