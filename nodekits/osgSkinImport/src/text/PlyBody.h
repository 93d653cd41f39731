// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PLYBODY_H
#define OSGSKINIMPORT_PLYBODY_H 1

#include "text/PlyHeader.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

/// What one entry of an element holds: for each property its value, or a list's values.
using PlyValues = std::vector<std::vector<double>>;

/// Takes an entry: the element, its number in it, and its values.
using TakePlyEntry =
    std::function<void(const PlyHeader::Element&, std::size_t index, const PlyValues&)>;

/// Reads all that comes after a PLY file's header. No more memory is taken than for one entry,
/// whatever the file says.
/// \param body all that comes after the header
/// \throw osgSkin::Error naming element and entry where a number is none, a list longer than the
///        file, or the file at its end too soon
void readPlyBody(const std::string& path, const PlyHeader& header, std::string_view body,
                 const TakePlyEntry& take);

} // namespace osgSkin

#endif
