// SPDX-License-Identifier: MIT
#pragma once

#include "Snapshots.h"

#include <osg/BoundingBox>
#include <osg/Vec3d>

namespace example {

/// The nearest view from a side that shows all of a box, with a margin of a tenth around it. Up is
/// z.
///
/// \param box not empty
/// \param side where the camera stands, from the box; any length, not straight up
/// \param aspect the picture's width to its height
View framed(const osg::BoundingBoxd& box, const osg::Vec3d& side, double aspect);

} // namespace example
