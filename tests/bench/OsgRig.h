// SPDX-License-Identifier: MIT
#pragma once

#include "BenchBody.h"

#include <osg/ref_ptr>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>

namespace bench {

/// The body under osgAnimation's own software rig.
class OsgRig {
public:
    explicit OsgRig(const Body& body);

    /// Puts the bones into a sample of the clip; not part of what is measured.
    void pose(std::size_t frame);
    /// The rig stands below it.
    osgAnimation::Skeleton* skeleton() const { return _skeleton.get(); }
    /// Skins the vertices and normals.
    void update() { _rig->update(); }

    /// Largest distance of a skinned vertex from linear blending worked out here: 0 where the rig
    /// does what it is measured for.
    double error(std::size_t frame) const;

private:
    const Body& _body;
    osg::ref_ptr<osgAnimation::Skeleton> _skeleton;
    osg::ref_ptr<osgAnimation::RigGeometry> _rig;
};

} // namespace bench
