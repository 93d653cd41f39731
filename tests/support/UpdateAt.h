// SPDX-License-Identifier: MIT
#pragma once

#include <osg/FrameStamp>
#include <osg/Node>
#include <osgUtil/UpdateVisitor>

namespace test {

/// One update traversal of `scene` at `time`, in seconds of simulation time and not negative; the
/// frame number is the time in milliseconds, for callbacks that run once per frame.
inline void updateAt(osg::Node& scene, double time) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    stamp->setFrameNumber(static_cast<unsigned>(1000.0 * time));
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    scene.accept(visitor);
}

} // namespace test
