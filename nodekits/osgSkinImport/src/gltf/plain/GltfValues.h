// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFVALUES_H
#define OSGSKINIMPORT_GLTFVALUES_H 1

#include "gltf/GltfAccessors.h"
#include "gltf/GltfFile.h"

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// Refuses what Assimp passes over without a word: corners of vertices that are not there, joints
/// that the skin has not, and weights that are none. Joints that a vertex does not follow may be
/// any, and weights a rounding error below 0. What Draco holds is left to Assimp.
///
/// \param file checked, and each of its meshes shown with one skin
/// \throw osgSkin::Error with the accessor and the place in it
void checkValues(const GltfFile& file, GltfAccessors& accessors);

/// Refuses numbers of an accessor that are none, or beyond all coordinates.
/// \param where the accessor is named
/// \throw osgSkin::Error with the accessor and the place in it
void requireCoordinates(const GltfFile& file, std::size_t accessor, const std::string& where,
                        const std::vector<double>& values);

} // namespace osgSkin

#endif
