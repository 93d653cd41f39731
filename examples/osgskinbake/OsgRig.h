// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace bake {

/// Makes a scene of osgAnimation alone of a rigged .glb file: bones, an
/// osgAnimation::RigGeometry for each material, all clips, morph targets. OpenSceneGraph plays it
/// without osgSkin. Metres, Z up, facing -Y.
///
/// \param glb written by writeRigged()
/// \param file with an extension of isSceneFile()
/// \throw osgSkin::Error if one cannot be read or the other not be written
void writeOsgRig(const std::string& glb, const std::string& file);

} // namespace bake
