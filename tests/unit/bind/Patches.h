// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/SkinMesh>

#include <cstdint>
#include <vector>

/// How many connected patches of regions there are beyond one for each region on each shell.
/// Vertices that share a position are one; vertices without a face do not count.
std::size_t severedPatches(const osgSkin::SkinMesh& mesh,
                           const std::vector<std::uint32_t>& regions);
