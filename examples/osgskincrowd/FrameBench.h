// SPDX-License-Identifier: MIT
#ifndef OSGSKINCROWD_FRAMEBENCH_H
#define OSGSKINCROWD_FRAMEBENCH_H

#include "Crowd.h"

#include <osg/Camera>
#include <osg/Node>
#include <osg/ref_ptr>

/// A line of text at the lower edge of the window: frame time and the crowd's share of it, averaged
/// over half a second.
osg::ref_ptr<osg::Camera> makeFrameTime(const Crowd& crowd, unsigned int threads);

/// Runs frames at 60 Hz without a window, with the whole scene in view. Prints the times of the
/// update and cull traversals, which are everything in a frame except drawing.
void benchFrames(const Crowd& crowd, osg::Node* scene, unsigned int frames, unsigned int threads);

#endif
