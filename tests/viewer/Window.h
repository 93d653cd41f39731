// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/Node>
#include <osgViewer/CompositeViewer>

#include <vector>

namespace test {

/// Windows of 300 x 300 pixels side by side, each with its own context and view of one scene, seen
/// from `eye`. Needs a display.
class Windows {
public:
    Windows(osg::Node* scene, const osg::Vec3d& eye, const osg::Vec3d& centre,
            unsigned int count = 1,
            osgViewer::ViewerBase::ThreadingModel model = osgViewer::ViewerBase::SingleThreaded);

    /// Draws a frame at `time`.
    void frame(double time = 0.0) { viewer.frame(time); }

    /// The windows' pictures after the last frame. With threads, draw the same frame a few times
    /// first, so that it is in them; this ends the threads.
    std::vector<osg::ref_ptr<osg::Image>> pictures();

    osgViewer::CompositeViewer viewer;

private:
    std::vector<osg::ref_ptr<osg::Image>> _images;
};

} // namespace test
