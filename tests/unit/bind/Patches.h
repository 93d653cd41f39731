// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/SkinMesh>

#include <cstdint>
#include <vector>

/// Number of connected patches of regions beyond one per region and shell. Vertices at the same
/// position are merged; vertices without a face do not count.
std::size_t severedPatches(const osgSkin::SkinMesh& mesh,
                           const std::vector<std::uint32_t>& regions);
