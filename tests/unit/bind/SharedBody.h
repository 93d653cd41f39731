// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// Real bodies that are not part of the repository (see the data's own README).
namespace shared {

/// The folder of the MakeHuman data, which may not exist.
std::filesystem::path makehuman();

/// Only positions and faces of a Wavefront file.
osgSkin::SkinMesh readObj(const std::filesystem::path& file);

/// A skeleton of rig/joints_*.json.
osgSkin::RestSkeleton readJoints(const std::filesystem::path& file);

/// The hand-painted weights, [vertex][joint], zero for joints without painted weights.
std::vector<std::vector<double>> readWeights(const std::filesystem::path& file,
                                             const osgSkin::RestSkeleton& skeleton,
                                             std::size_t vertices);

} // namespace shared
