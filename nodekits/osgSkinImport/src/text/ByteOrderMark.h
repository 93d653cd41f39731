// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BYTEORDERMARK_H
#define OSGSKINIMPORT_BYTEORDERMARK_H 1

#include <cstddef>
#include <string_view>

namespace osgSkin {

/// The length of the byte order mark that a text begins with; 0 where it has none.
inline std::size_t byteOrderMark(std::string_view text) {
    return text.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0;
}

} // namespace osgSkin

#endif
