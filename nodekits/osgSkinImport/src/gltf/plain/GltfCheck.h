// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFCHECK_H
#define OSGSKINIMPORT_GLTFCHECK_H 1

#include "gltf/GltfFile.h"

#include <nlohmann/json.hpp>

namespace osgSkin {

/// What is read of a glTF 2 file, checked, before Assimp sees it: Assimp believes indices, counts
/// and sizes, and calls itself for each level of nodes.
///
/// Nodes are trees of no more than the allowed depth, each index names something, accessors lie in
/// their buffer views and these in their buffers, attributes of a primitive have one count, and
/// what is asked for is in proportion to the file's size. Extras, cameras, lights, morph targets
/// and unknown extensions are not in it.
/// \throw osgSkin::Error with the file, the path in it and what was expected
/// \throw nlohmann::json::exception where a member is missing or of another type
/// \param file after loadBuffers()
nlohmann::json checkedGltf(const GltfFile& file);

} // namespace osgSkin

#endif
