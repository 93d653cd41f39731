// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_SCENE_BUILDSCENE_H
#define OSGSKINCHARACTER_SCENE_BUILDSCENE_H

#include "source/CharacterSource.h"

#include <osgSkinCharacter/Character>
#include <osgSkinCharacter/LoadOptions>

#include <osg/BoundingSphere>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osgAnimation/Animation>

namespace osgSkin {

/// A sphere around everything under `root` while the first of `clips` plays. Sets bones and skins
/// to its first pose; without clips they keep their pose. A viewer places its camera before the
/// first frame, so it needs these bounds.
///
/// \param root without an update callback of its own
osg::BoundingSphere playedBounds(osg::Group& root, const osgAnimation::AnimationList& clips);

/// Lets OpenGL normalise the normals below a transform that scales, which are lit too brightly or
/// too darkly otherwise.
void normalizeIfScaled(osg::MatrixTransform& transform);

/// Builds the scene of a bound character, Z up: skeleton, skins, rigid parts, props, and the
/// manager that plays its motions; in the first motion's first pose.
///
/// \param source its skeleton becomes the scene's
/// \param options of the caller
/// \param character with its body, rest skeleton, binding and retargeted motions; gets the scene
/// \throw Error where parts do not fit, or a prop cannot be read
void buildScene(CharacterSource& source, const LoadOptions& options, Character& character);

} // namespace osgSkin

#endif
