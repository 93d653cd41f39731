// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene/PropMeshes.h"
#include "source/CharacterSource.h"

#include <osgSkinCharacter/CharacterMotion>

#include <osg/Group>
#include <osgDB/Options>

namespace osgSkin {

/// Adds the props of a motion, moved by further channels of its animation, so that a prop keeps
/// time with the figure. Their paths are scaled and placed as the root's was.
///
/// \param source that names the props; counts their samples
/// \param motion that they belong to; retargeted
/// \param parent gets a child for each prop; in skeleton space
/// \param meshes of the props of all motions
/// \param options for the props' motions; may be null
/// \throw Error with the file and the place in it
void addProps(CharacterSource& source, const CharacterMotion& motion, osg::Group& parent,
              PropMeshes& meshes, const osgDB::Options* options);

} // namespace osgSkin
