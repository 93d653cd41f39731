// SPDX-License-Identifier: MIT
// Where a clip has the feet, and when they stand.
#pragma once

#include <osgSkin/GlmTypes>
#include <osgSkinMotion/SampledClip>

#include <array>
#include <cstddef>
#include <vector>

namespace osgSkin {

/// The feet of a figure in its clips, and the way to a space with Z up, in which they are measured.
struct TrackedFeet {
    std::array<std::size_t, 2> ankles{}; ///< joints of the clips; left, right
    std::array<glm::dvec3, 2> balls{};   ///< of the feet, rest space
    glm::dmat4 toLevel{1.0};             ///< from rest space to the space with Z up
    glm::dvec3 forward{0.0};             ///< unit, level there
    double leg = 0.0;                    ///< from hip to ankle
};

/// Where the figure is in a clip's samples, in the space with Z up.
struct FootTrack {
    std::vector<glm::dvec3> root;                ///< the root joint
    std::array<std::vector<glm::dvec3>, 2> ball; ///< of the left and the right foot
};
FootTrack findTrack(const SampledClip& clip, const TrackedFeet& feet);

/// How far the left foot is in front of the right one, [sample].
std::vector<double> leftAhead(const FootTrack& track, const glm::dvec3& forward);

/// The largest angle between two poses' joints.
double poseDistance(const SampledClip& clip, const JointSample* a, const JointSample* b);

/// Whether a clip's end continues its beginning, apart from its way along the ground.
bool isLoop(const SampledClip& clip);

/// The number of samples of one cycle: from one foot in front to the same again. Of a clip with
/// less, twice the time from one foot to the other. 0 where there is no step of both feet.
std::size_t findPeriod(const std::vector<double>& ahead, bool isLoop);

/// How fast the lower foot moves back against the root, which is how fast the figure goes: the
/// median over the samples in which it is low.
/// \param step seconds from one sample to the next
double speedOfFeet(const FootTrack& track, const TrackedFeet& feet, double step, bool isLoop);

} // namespace osgSkin
