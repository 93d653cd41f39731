// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "file/SkinOptions.h"
#include "load/Character.h"

#include <osg/Group>
#include <osg/ref_ptr>
#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads a rigged model that Assimp reads (isReadByAssimp()) and re-skins it. Its `file` holds the
/// model's own file and its up axis, and no motions. \throw Error with the file and the reason
Character loadRig(const std::string& file, const osgDB::Options* options,
                  const SkinOptions& wanted);

/// Reads any rigged file and re-skins it: what Assimp reads by loadRig(), anything else by osgDB
/// and convertRigs(). The first clip plays, or the one that the options name.
///
/// \throw Error with the file and the reason, also where nothing in it is rigged
osg::ref_ptr<osg::Group> loadRigCharacter(const std::string& file, const osgDB::Options* options,
                                          const SkinOptions& wanted);

} // namespace osgSkin
