// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinBind/BindWeights>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <string>

namespace quality {

/// A body with a skeleton and painted weights, not bound yet.
struct PaintedBody {
    std::string name;
    osgSkin::SkinMesh mesh;
    osgSkin::RestSkeleton rig;
    osgSkin::VertexWeights painted; ///< one list for each vertex, over the rig's joints
};

/// \param body mesh file
/// \param rig skeleton file
/// \param weights JSON of painted weights
/// \throw osgSkin::Error where a file cannot be read or does not fit the others
PaintedBody loadBody(const std::string& body, const std::string& rig, const std::string& weights);

} // namespace quality
