// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/PlayedBounds.h"

#include <osgSkin/AutoPlayManager>

#include <osg/ComputeBoundsVisitor>
#include <osg/FrameStamp>
#include <osgUtil/UpdateVisitor>

namespace osgSkin {
namespace {

constexpr int kSamples = 24;

void update(osg::Node& root, double time) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(stamp);
    root.accept(visitor);
}

} // namespace

osg::BoundingSphere playedBounds(osg::Group& root, const osgAnimation::AnimationList& clips) {
    // A manager of its own: the one that plays later begins at 0.
    double duration = 0.0;
    if (!clips.empty()) {
        const osg::ref_ptr<AutoPlayManager> manager = new AutoPlayManager;
        manager->registerAnimation(clips.front());
        root.setUpdateCallback(manager);
        manager->playAnimation(clips.front());
        duration = clips.front()->getDuration();
    }
    osg::BoundingBox box;
    for (int k = kSamples - 1; k >= 0; --k) { // the first pose last
        update(root, duration * k / kSamples);
        osg::ComputeBoundsVisitor bounds(osg::NodeVisitor::TRAVERSE_ACTIVE_CHILDREN);
        root.accept(bounds);
        box.expandBy(bounds.getBoundingBox());
        if (duration <= 0.0) break;
    }
    root.setUpdateCallback(nullptr);
    return box.valid() ? osg::BoundingSphere(box) : osg::BoundingSphere();
}

} // namespace osgSkin
