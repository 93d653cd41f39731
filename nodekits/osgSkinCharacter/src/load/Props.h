// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "load/Character.h"

#include <osg/Group>
#include <osgAnimation/Animation>
#include <osgDB/Options>

namespace osgSkin {

/// Adds the props of `motion` under `parent` (skeleton space), moved by channels of `animation`, so
/// that a prop keeps time with the figure. Their way is scaled and placed as the root's was.
/// \throw Error with file and place
void addProps(const SkinFile& file, const Character::Motion& motion, osg::Group& parent,
              osgAnimation::Animation& animation, const osgDB::Options* options);

} // namespace osgSkin
