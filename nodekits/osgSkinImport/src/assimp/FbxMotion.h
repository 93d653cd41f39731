// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMP_FBXMOTION_H
#define OSGSKINIMPORT_ASSIMP_FBXMOTION_H

#include "assimp/FbxModels.h"
#include "scene/SourceScene.h"

#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Corrects what Assimp's reader makes of an FBX file's transforms and animations, by the file
/// itself:
/// - models with pivots and offsets of rotation or scale, whose animations Assimp drops;
/// - geometric transforms (3ds Max's object offset), which move a model's mesh only;
/// - models that do not inherit their parent's scale (Maya's segment scale compensate);
/// - curves with steps and tangents, and rotations by Euler angles between keys that are far apart.
///   They are sampled at their keys and 30 times a second.
///
/// Of an animation's layers, the first that moves a property is used; others are reported.
/// \param models of the file; they find their nodes
/// \param path of the file, for messages
/// \param scene as Assimp read it
/// \throw osgSkin::Error if animations have more samples than the file has room for
void correctFbx(FbxModels& models, const std::string& path, const ReadLimits& limits,
                SourceScene& scene);

} // namespace osgSkin

#endif
