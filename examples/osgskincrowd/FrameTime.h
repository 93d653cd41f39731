// SPDX-License-Identifier: MIT
#pragma once

#include "Crowd.h"

#include <osg/Camera>
#include <osg/ref_ptr>

/// A line of text at the window's lower edge: how long frames take, and what the crowd's part of
/// that is; means over half a second.
osg::ref_ptr<osg::Camera> makeFrameTime(const Crowd& crowd, unsigned int threads);
