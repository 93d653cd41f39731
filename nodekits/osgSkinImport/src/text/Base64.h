// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BASE64_H
#define OSGSKINIMPORT_BASE64_H 1

#include <string>
#include <string_view>

namespace osgSkin {

/// Decodes base64; blanks and line ends are skipped.
/// \throw osgSkin::Error with the reason alone where the text contains anything else
std::string fromBase64(std::string_view text);

/// Encodes bytes as base64, padded.
std::string toBase64(std::string_view bytes);

} // namespace osgSkin

#endif
