// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinMotion/SampledClip>

#include <osg/Callback>
#include <osg/Node>
#include <osg/ref_ptr>
#include <osgAnimation/Animation>
#include <osgAnimation/Skeleton>

#include <string>
#include <vector>

namespace osgSkin {

/// The animations of all managers at and below a node.
osgAnimation::AnimationList animationsOf(osg::Node& root);

/// Removes all animation managers at and below a node, each once, in the scene's order.
std::vector<osg::ref_ptr<osg::Callback>> takeManagers(osg::Node& root);

/// The first animation of a name, sampled 60 times a second.
/// \param label begins errors
/// \throw osgSkin::Error where there is none, and from SampledClip::create()
osg::ref_ptr<const SampledClip> sampleNamed(const std::string& name,
                                            const osgAnimation::AnimationList& animations,
                                            osgAnimation::Skeleton& skeleton,
                                            const std::string& label);

/// SampledClip::create(), with a notice where the animation moves morph targets.
osg::ref_ptr<const SampledClip> sampleOf(const osgAnimation::Animation& animation,
                                         osgAnimation::Skeleton& skeleton,
                                         double samplesPerSecond = 60.0);

} // namespace osgSkin
