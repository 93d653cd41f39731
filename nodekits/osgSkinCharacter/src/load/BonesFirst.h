// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osg/Node>

namespace osgSkin {

/// Puts bones before what else hangs on a bone, as osgAnimation wants them and warns of else: they
/// are updated in this order.
void putBonesFirst(osg::Node& scene);

} // namespace osgSkin
