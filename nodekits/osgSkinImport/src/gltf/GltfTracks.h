// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFTRACKS_H
#define OSGSKINIMPORT_GLTFTRACKS_H 1

#include "gltf/GltfAccessors.h"
#include "gltf/GltfFile.h"

namespace osgSkin {

/// Makes all tracks of nodes' translation, rotation and scale linear ones of floats, which is all
/// that Assimp reads rightly: steps become pairs of keys, cubic splines are sampled at each key and
/// 30 times a second between them. Tracks of other things are taken out.
/// \throw osgSkin::Error where a track has not a value a key, or times go back
void makeTracksLinear(GltfFile& file, GltfAccessors& accessors);

} // namespace osgSkin

#endif
