// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MTLCHECK_H
#define OSGSKINIMPORT_MTLCHECK_H 1

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace osgSkin {

/// What is left of a library of materials.
struct CheckedMtl {
    std::string text;                ///< the lines that were checked, in their order
    std::size_t placedTextures = 0;  ///< that are moved or scaled (-o, -s), which nothing here does
    std::size_t opacityTextures = 0; ///< map_d, which is left out
    std::size_t glowTextures = 0;    ///< map_Ke, which is left out with the colour that it shades
};

/// Checks a library of materials before tinyobjloader parses it. Nothing is refused: lines are kept
/// that have a keyword which is used, and numbers that are some.
/// \param wanted names of materials: others are left out, and each is taken off when it is found
CheckedMtl checkMtl(std::string_view text, std::set<std::string>& wanted);

} // namespace osgSkin

#endif
