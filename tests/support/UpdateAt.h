// SPDX-License-Identifier: MIT
#pragma once

#include <osg/FrameStamp>
#include <osg/Node>
#include <osgUtil/UpdateVisitor>

namespace test {

/// One update traversal of `scene` at `time`, in seconds of the simulation's clock and not
/// negative; the frame's number is its millisecond, for callbacks that run once a frame.
inline void updateAt(osg::Node& scene, double time) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    stamp->setFrameNumber(static_cast<unsigned>(1000.0 * time));
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    scene.accept(visitor);
}

} // namespace test
