// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osg/BoundingSphere>
#include <osg/Group>
#include <osgAnimation/Animation>

namespace osgSkin {

/// A sphere that holds all that is under `root` while the first of `clips` plays, and leaves bones
/// and skins in its first pose; without clips, in the pose that they have. A viewer places its
/// camera before the first frame, so it must be told where the figure will get to.
///
/// \param root without an update callback of its own
osg::BoundingSphere playedBounds(osg::Group& root, const osgAnimation::AnimationList& clips);

} // namespace osgSkin
