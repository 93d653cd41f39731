// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_URI_H
#define OSGSKINIMPORT_URI_H 1

#include <string>
#include <string_view>

namespace osgSkin {

/// A file's name as a URI has it, with "%20" for a space and the like, in plain characters.
std::string decodedUri(std::string_view uri);

/// Whether a URI holds what it stands for: "data:application/octet-stream;base64,AAAA".
bool isDataUri(std::string_view uri);

/// The bytes that a data URI holds, in base64 or as they stand, with "%2B" and the like.
/// \throw osgSkin::Error with the reason alone where it is none
std::string dataOfUri(std::string_view uri);

} // namespace osgSkin

#endif
