// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinCharacter/Character>
#include <osgSkinCharacter/LoadOptions>

namespace osgSkin {

/// Takes over the animations of a scene that osgDB has read, as LoadOptions has it: the wanted one
/// plays, else the first. Of a scene with one animation manager, the character's root gets a
/// manager that plays again when saved and read, in place of the scene's own, and the character its
/// motions; several managers stay where they are and play the first of theirs.
///
/// \param options of the caller
/// \param character with `file` and the scene as its root
/// \throw Error where the motion that is asked for is none of the scene's, with those that are: motion
///        files are not carried over to skeletons of other makers' scenes
void takeSceneMotions(const LoadOptions& options, Character& character);

} // namespace osgSkin
