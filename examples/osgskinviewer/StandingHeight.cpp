// SPDX-License-Identifier: MIT
#include "StandingHeight.h"

#include <osg/FrameStamp>
#include <osg/Transform>
#include <osg/TriangleFunctor>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <limits>
#include <vector>

namespace viewer {
namespace {

constexpr unsigned int kSamples = 40;

struct Lowest {
    osg::Matrix toRoot;
    double z = std::numeric_limits<double>::max();

    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c) {
        for (const osg::Vec3* point : {&a, &b, &c})
            z = std::min(z, (osg::Vec3d(*point) * toRoot).z());
    }
};

/// Finds the lowest point of the triangles in a scene: bounds are too generous for that.
class LowestPoint : public osg::NodeVisitor {
public:
    LowestPoint() : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {}

    void apply(osg::Drawable& drawable) override {
        triangles.toRoot = osg::computeLocalToWorld(getNodePath());
        drawable.accept(triangles);
    }

    osg::TriangleFunctor<Lowest> triangles;
};

double lowestPointAt(osg::Group& root, double time) {
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    osgUtil::UpdateVisitor update;
    update.setFrameStamp(stamp);
    root.accept(update);
    LowestPoint lowest;
    root.accept(lowest);
    return lowest.triangles.z;
}

} // namespace

double standingHeight(const Figure& figure, std::size_t motion) {
    if (figure.motionCount() == 0) return lowestPointAt(*figure.root, 0.0);
    // Played by a manager of its own: the figure's has a time that is not to be touched.
    const osg::ref_ptr<osg::Callback> playing = figure.managed->getUpdateCallback();
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    osgAnimation::Animation& clip = figure.motion(motion);
    manager->registerAnimation(&clip);
    manager->playAnimation(&clip);
    figure.managed->setUpdateCallback(manager);
    std::vector<double> heights;
    for (unsigned int k = 0; k < kSamples; ++k)
        heights.push_back(lowestPointAt(*figure.root, clip.getDuration() * k / kSamples));
    figure.managed->setUpdateCallback(playing);
    const auto tenth = heights.begin() + kSamples / 10;
    std::nth_element(heights.begin(), tenth, heights.end());
    return *tenth;
}

} // namespace viewer
