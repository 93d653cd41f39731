// SPDX-License-Identifier: MIT
#ifndef OSGSKINCROWD_FRAMEBENCH_H
#define OSGSKINCROWD_FRAMEBENCH_H

#include "Crowd.h"
#include "Snapshots.h"

#include <osg/Camera>
#include <osg/Drawable>
#include <osg/FrameStamp>
#include <osg/Node>
#include <osg/Viewport>
#include <osg/ref_ptr>
#include <osgUtil/CullVisitor>

#include <vector>

/// A line of text at the lower edge of the window.
/// \param update sets the text
osg::ref_ptr<osg::Camera> makeTextLine(osg::DrawableUpdateCallback* update);

double medianOf(std::vector<double> values);

/// A cull traversal of a scene, without drawing.
class FrameCull {
public:
    explicit FrameCull(const example::View& view); ///< at 1920 x 1080
    explicit FrameCull(
        const osg::BoundingSphere& bound); ///< of all of it, from above, at 1000 x 800
    void run(osg::Node& scene, osg::FrameStamp* stamp);

private:
    osg::ref_ptr<osgUtil::CullVisitor> _visitor = new osgUtil::CullVisitor;
    osg::ref_ptr<osgUtil::StateGraph> _graph = new osgUtil::StateGraph;
    osg::ref_ptr<osgUtil::RenderStage> _stage = new osgUtil::RenderStage;
    osg::ref_ptr<osg::Viewport> _viewport;
    osg::ref_ptr<osg::RefMatrix> _view, _projection;
};

/// A line of text at the lower edge of the window: frame time and the crowd's share of it, averaged
/// over half a second.
osg::ref_ptr<osg::Camera> makeFrameTime(const Crowd& crowd, unsigned int threads);

/// Runs frames at 60 Hz without a window, with the whole scene in view. Prints the times of the
/// update and cull traversals, which are everything in a frame except drawing.
void benchFrames(const Crowd& crowd, osg::Node* scene, unsigned int frames, unsigned int threads);

#endif
