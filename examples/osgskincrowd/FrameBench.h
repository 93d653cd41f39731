// SPDX-License-Identifier: MIT
#ifndef OSGSKINCROWD_FRAMEBENCH_H
#define OSGSKINCROWD_FRAMEBENCH_H

#include "Crowd.h"

#include <osg/Camera>
#include <osg/Node>
#include <osg/ref_ptr>

/// A line of text at the window's lower edge: how long frames take, and what the crowd's part of
/// that is; means over half a second.
osg::ref_ptr<osg::Camera> makeFrameTime(const Crowd& crowd, unsigned int threads);

/// Runs frames without a window, one 60th of a second apart, with all of the scene in view, and
/// prints what update and cull traversals took: everything of a frame but the drawing.
void benchFrames(const Crowd& crowd, osg::Node* scene, unsigned int frames, unsigned int threads);

#endif
