// SPDX-License-Identifier: MIT
#pragma once

#include "clips/BakedClip.h"

#include <osgSkin/GlmTypes>
#include <osgSkin/Pose>

#include <array>
#include <vector>

namespace osgSkin {

/// A skin at one time.
struct SkinMoment {
    Pose pose;
    std::vector<glm::vec3> positions; ///< of all vertices
};

/// Adds boxes that hold a skin all the way from one sample to the next, one for each part of it.
///
/// Within a part a vertex leaves the straight line between the part's ends by an eighth of its
/// second derivative at most. Second differences, here and there on the way, tell that one; twice
/// as much is added to the box. What is not smooth they do not tell: a joint that comes near half a
/// turn, where its bend axis or its twist may jump. Then the boxes are not valid ones.
///
/// \param moments at even steps, both ends included
/// \param boxes gets one for each part
void boundWay(const std::array<SkinMoment, BakedClip::kParts + 1>& moments,
              std::vector<osg::BoundingBox>& boxes);

} // namespace osgSkin
