// SPDX-License-Identifier: MIT
#include "gltf/Uri.h"

#include "text/Base64.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <charconv>

namespace osgSkin {

std::string decodedUri(std::string_view uri) {
    std::string result;
    result.reserve(uri.size());
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const char* const digits = uri.data() + i + 1;
        const bool isCode = uri[i] == '%' && i + 2 < uri.size() &&
                            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
        result.push_back(isCode ? static_cast<char>(code) : uri[i]);
        if (isCode) i += 2;
    }
    return result;
}

bool isDataUri(std::string_view uri) {
    return osgDB::convertToLowerCase(std::string(uri.substr(0, 5))) == "data:";
}

std::string dataOfUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) throw Error("no comma, expected data behind one");
    const std::string kind = osgDB::convertToLowerCase(std::string(uri.substr(0, comma)));
    const std::string_view data = uri.substr(comma + 1), base64 = ";base64";
    const bool isBase64 = kind.size() >= base64.size() &&
                          kind.compare(kind.size() - base64.size(), base64.size(), base64) == 0;
    if (!isBase64) return decodedUri(data);
    return fromBase64(
        data.find('%') == std::string_view::npos ? data : std::string_view(decodedUri(data)));
}

} // namespace osgSkin
