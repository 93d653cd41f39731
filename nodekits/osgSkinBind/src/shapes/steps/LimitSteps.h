// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_LIMITSTEPS_H
#define OSGSKINBIND_LIMITSTEPS_H

#include "shapes/ShapeFit.h"
#include "shapes/ShapedJoint.h"

namespace osgSkin {

/// Changes a joint's shapes so that no vertex moves faster than 1.5 times as fast as the joint
/// would take it about its axis as a rigid body. Flesh near the axis hardly turns, and may be
/// squeezed away from there much faster: a single vertex would be seen to slip. Such shapes come in
/// earlier and slower; where that is not enough, they are less.
///
/// Its neighbours keep less of their shapes, too, the farther from it the more, so that no crease
/// comes of it.
void limitSteps(const ShapedJoint& joint, FittedShapes& shapes);

} // namespace osgSkin

#endif
