// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFJSON_H
#define OSGSKINIMPORT_GLTFJSON_H 1

#include <nlohmann/json.hpp>

#include <string>

namespace osgSkin {

/// A glTF file's text. Zeros may pad its end, as exporters of binary files write them.
/// \throw osgSkin::Error with the file and the place where it is no JSON, or an object has a member
///        twice, of which a parser would keep one without a word
nlohmann::json parseGltf(const std::string& path, std::string text);

} // namespace osgSkin

#endif
