// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/Clip>

#include <osg/ref_ptr>
#include <osgAnimation/Channel>

#include <cstddef>

namespace osgSkin {

/// A joint's rotations as a channel "quaternion", without a target yet.
osg::ref_ptr<osgAnimation::Channel> rotationChannel(const Clip& clip, std::size_t joint);

/// The root's positions as a channel "translate", without a target yet.
osg::ref_ptr<osgAnimation::Channel> rootChannel(const Clip& clip);

} // namespace osgSkin
