// SPDX-License-Identifier: MIT
#pragma once

#include "assimp/SceneBind.h"

#include <set>

namespace osgSkin {

/// The nodes that some clip moves from where they stand. Exporters give others tracks, too, which
/// hold them where they are.
std::set<const aiNode*> movedNodes(const aiScene& scene, const SceneBind& bind);

} // namespace osgSkin
