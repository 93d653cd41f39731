// SPDX-License-Identifier: MIT
#include "PaintedBody.h"

#include <osgSkinCharacter/ReadWeights>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportSkeleton>

#include <filesystem>

namespace quality {

PaintedBody loadBody(const std::string& body, const std::string& rig, const std::string& weights) {
    PaintedBody loaded;
    loaded.name = std::filesystem::path(body).stem().string();
    loaded.mesh = osgSkin::importMesh(body).mesh;
    loaded.rig = osgSkin::importSkeleton(rig);
    loaded.painted = osgSkin::readWeights(weights, loaded.rig, loaded.mesh.positions.size());
    return loaded;
}

} // namespace quality
