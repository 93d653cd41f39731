// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MTLCHECK_H
#define OSGSKINIMPORT_MTLCHECK_H 1

#include <set>
#include <string>
#include <string_view>

namespace osgSkin {

struct CheckedMtl {
    std::string text;
    std::size_t placedTextures = 0; ///< that are moved or scaled (-o, -s), which nothing here does
};

/// The same of a library of materials, where nothing is refused: lines with a keyword that is used,
/// and numbers that are some.
/// \param wanted names of materials: others are left out, and each is taken off when it is found
CheckedMtl checkMtl(std::string_view text, std::set<std::string>& wanted);

} // namespace osgSkin

#endif
