// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_CORRECTIVES_LIMITVELOCITY_H
#define OSGSKINBINDER_CORRECTIVES_LIMITVELOCITY_H

#include "correctives/ShapeFit.h"
#include "correctives/ShapedJoint.h"

namespace osgSkin {

/// Changes a joint's shapes so that no vertex moves more than 1.5 times as fast as the joint would
/// rotate it as part of a rigid body. Flesh near the axis hardly rotates but may be squeezed away
/// much faster, and a single vertex would visibly slip. Such shapes begin earlier and grow slower;
/// if that is not enough, they are weakened, and those of neighbours gradually with them, so that
/// no crease forms.
void limitVelocity(const ShapedJoint& joint, FittedShapes& shapes);

} // namespace osgSkin

#endif
