// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/SampledClip>

#include <osgSkin/Binding>
#include <osgSkin/Pose>

#include <osgAnimation/Bone>
#include <osgAnimation/UpdateBone>

#include <vector>

namespace osgSkin {

/// Puts copies of what moves a skeleton's bones through an animation, as fast as it plays. The
/// skeleton stays as it is.
class BoneSampler {
public:
    /// \throw osgSkin::Error where the skeleton has no bone
    BoneSampler(const osgAnimation::Animation& animation, osgAnimation::Skeleton& skeleton);

    double duration() const { return _animation->getDuration() / _speed; } ///< seconds
    std::vector<SampledClip::Joint> joints() const;

    /// Adds what the joints do at a time, against their parents.
    /// \throw osgSkin::Error where a bone's matrix cannot be used
    void append(double time, std::vector<JointSample>& samples);

private:
    osg::ref_ptr<osgAnimation::Animation> _animation;             ///< as long as its keys
    double _speed;                                                ///< keySpeed()
    std::vector<osg::ref_ptr<osgAnimation::Bone>> _bones;         ///< parents before children
    std::vector<osg::ref_ptr<osgAnimation::UpdateBone>> _updates; ///< a bone each, or null
    std::vector<BoundJoint> _joints;
    Pose _pose;
};

} // namespace osgSkin
