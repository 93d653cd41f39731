// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/Node>
#include <osgViewer/CompositeViewer>

#include <vector>

namespace test {

/// Windows of 300 x 300 pixels side by side, each with a context and a view of its own of one
/// scene, seen from `eye`. Needs a display.
class Windows {
public:
    Windows(osg::Node* scene, const osg::Vec3d& eye, const osg::Vec3d& centre,
            unsigned int count = 1,
            osgViewer::ViewerBase::ThreadingModel model = osgViewer::ViewerBase::SingleThreaded);

    /// Draws a frame of time `time`.
    void frame(double time = 0.0) { viewer.frame(time); }

    /// The windows' pictures, as the last frame has left them. With threads: draw the same frame
    /// some times, so that it is in them; the threads end.
    std::vector<osg::ref_ptr<osg::Image>> pictures();

    osgViewer::CompositeViewer viewer;

private:
    std::vector<osg::ref_ptr<osg::Image>> _images;
};

} // namespace test
