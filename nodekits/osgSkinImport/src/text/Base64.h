// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BASE64_H
#define OSGSKINIMPORT_BASE64_H 1

#include <string>
#include <string_view>

namespace osgSkin {

/// The bytes that base64 stands for; blanks and line ends are passed over.
/// \throw osgSkin::Error with the reason alone where there is anything else
std::string fromBase64(std::string_view text);

/// Bytes as base64, padded.
std::string toBase64(std::string_view bytes);

} // namespace osgSkin

#endif
