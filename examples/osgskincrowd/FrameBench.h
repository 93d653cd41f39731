// SPDX-License-Identifier: MIT
#pragma once

#include "Crowd.h"

#include <osg/Node>

/// Runs frames without a window, one 60th of a second apart, with all of the scene in view, and
/// prints what update and cull traversals took: everything of a frame but the drawing.
void benchFrames(const Crowd& crowd, osg::Node* scene, unsigned int frames, unsigned int threads);
