// SPDX-License-Identifier: MIT
#pragma once

#include "feet/FootTrack.h"

#include <osgSkinMotion/Gaits>
#include <osgSkinMotion/SampledClip>

#include <osg/ref_ptr>

#include <array>
#include <string>
#include <vector>

namespace osgSkin {

/// A figure's legs and the way to walker space, in which clips are measured.
struct WalkingBody : TrackedFeet {
    std::array<Gaits::Leg, 2> legs;
    std::size_t hips = 0; ///< the joint whose turning is the figure's
};

/// The mean speed along the ground, units of walker space a second; of a clip on the spot as the
/// feet on the floor show it.
double meanSpeed(const SampledClip& clip, const WalkingBody& body);

/// Cuts one cycle out of a clip, puts it on the spot, above the origin and looking forward, and
/// measures it.
///
/// \param clip a walk or a run of one cycle or more
/// \param body the figure
/// \param floor the height of the standing figure's ball of the foot
/// \param slide how far the planted feet slide in the result, as a share of the stride
/// \throw osgSkin::Error where it has no step of both feet, or does not go forward
Gaits::Gait findCycle(const SampledClip& clip, const WalkingBody& body, double floor,
                      double& slide);

/// A clip on the spot, above the origin and looking forward, with its own length; it loops.
osg::ref_ptr<const SampledClip> onTheSpot(const SampledClip& clip, const WalkingBody& body);

} // namespace osgSkin
