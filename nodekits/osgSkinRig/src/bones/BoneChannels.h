// SPDX-License-Identifier: MIT
#pragma once

#include <osgAnimation/Bone>
#include <osgAnimation/Channel>

#include <string>
#include <vector>

namespace osgSkin {

/// The channels of a bone's own update callback, for matrices to the bone above.
class BoneChannels {
public:
    /// \throw osgSkin::Error where no channel could move the bone to any place and rotation: it has
    ///        no update callback, one without a name, or other elements than a named translation
    ///        and a named rotation, perhaps with a scale
    explicit BoneChannels(osgAnimation::Bone& bone);

    /// Adds a key to each.
    /// \throw osgSkin::Error where the matrix is scaled and there is no element for it
    void add(double time, const osg::Matrixd& local);

    const std::vector<osg::ref_ptr<osgAnimation::Channel>>& channels() const { return _channels; }

private:
    osg::ref_ptr<osgAnimation::Vec3LinearChannel> _translate, _scale; ///< the latter may be null
    osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> _rotate;
    std::vector<osg::ref_ptr<osgAnimation::Channel>> _channels;
    std::string _bone;
    osg::Quat _last;
};

} // namespace osgSkin
