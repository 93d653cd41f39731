// SPDX-License-Identifier: MIT
#pragma once

namespace mannequin {

constexpr int kFrameRate = 120; ///< frames per second

/// Frames in the loop. The last frame repeats the first; the figure does not move in either.
constexpr int kFrameCount = 360;

/// Frames of the events at which the literature reports angles.
///
/// Pitchers take 145 ms from the contact to the release, and 30 to 50 ms from the maximum external
/// rotation to the release (Fleisig et al. 1999; Dillman et al. 1993). A display at 60 Hz shows
/// nine and two to three frames of that. This throw takes 183 and 75 ms, so that the arm can be
/// seen.
constexpr int kKneeUpFrame = 55;       ///< highest lift of the lead (left) knee
constexpr int kContactFrame = 108;     ///< the lead foot is flat on the floor
constexpr int kMaxExternalFrame = 121; ///< maximum external rotation of the throwing shoulder
constexpr int kReleaseFrame = 130;     ///< the ball leaves the hand
constexpr int kLeadLeavesFrame = 262;  ///< the ball of the lead foot is planted until here

/// Time of a frame in seconds.
constexpr double frameTime(int frame) {
    return static_cast<double>(frame) / kFrameRate;
}

constexpr double kKneeUp = frameTime(kKneeUpFrame);
constexpr double kContact = frameTime(kContactFrame);
constexpr double kMaxExternal = frameTime(kMaxExternalFrame);
constexpr double kRelease = frameTime(kReleaseFrame);

constexpr double loopSeconds() {
    return frameTime(kFrameCount - 1);
}

} // namespace mannequin
