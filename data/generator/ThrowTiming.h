// SPDX-License-Identifier: MIT
#pragma once

namespace mannequin {

constexpr int kFrameRate = 120; ///< frames in a second

/// Frames in the loop. The last shows the first pose again, both at rest.
constexpr int kFrameCount = 360;

/// Frames of the events that the literature measures at.
///
/// Pitchers take 145 ms from the contact to the release and 30 to 50 ms from the greatest external
/// rotation to the release (Fleisig et al. 1999; Dillman et al. 1993): four to nine frames of a
/// display at 60 Hz. Here it is 183 and 75 ms, so that the arm can be seen.
constexpr int kKneeUpFrame = 55;       ///< highest lift of the lead (left) knee
constexpr int kContactFrame = 108;     ///< the lead foot is flat on the floor
constexpr int kMaxExternalFrame = 121; ///< greatest external rotation of the throwing shoulder
constexpr int kReleaseFrame = 130;     ///< the ball leaves the hand
constexpr int kLeadLeavesFrame = 262;  ///< until then the ball of the lead foot stays planted

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
