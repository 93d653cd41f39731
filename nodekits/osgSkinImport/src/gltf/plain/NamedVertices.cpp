// SPDX-License-Identifier: MIT
#include "gltf/plain/NamedVertices.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace osgSkin {

std::size_t NamedVertices::count(std::size_t accessor, std::size_t vertices) {
    const auto [known, isNew] = _known.emplace(std::make_pair(accessor, vertices), 0);
    if (isNew) known->second = counted(accessor, vertices);
    return known->second;
}

std::size_t NamedVertices::counted(std::size_t accessor, std::size_t vertices) const {
    const nlohmann::json& source = _parts.at("accessors")[accessor];
    const std::size_t corners = _parts.count(accessor);
    const std::size_t bytes = _parts.bytesOfComponent(accessor);
    if (!source.contains("bufferView") || source.contains("sparse"))
        return std::min(corners, vertices);
    const nlohmann::json& view = source.at("bufferView");
    const std::size_t offset = source.value("byteOffset", std::size_t{0});
    const std::size_t given =
        _parts.at("bufferViews")[view.get<std::size_t>()].value("byteStride", std::size_t{0});
    const std::size_t stride = given == 0 ? bytes : given;
    const std::string_view numbers = _parts.bytesOf(view);
    std::vector<bool> isNamed(vertices, false);
    std::size_t result = 0;
    for (std::size_t corner = 0; corner < corners; ++corner) {
        const std::size_t at = offset + corner * stride;
        if (at + bytes > numbers.size()) return std::min(corners, vertices); // not in this file
        std::size_t vertex = 0;                                              // little-endian
        for (std::size_t k = bytes; k > 0; --k)
            vertex = vertex << 8u | static_cast<unsigned char>(numbers[at + k - 1]);
        if (vertex >= vertices || isNamed[vertex]) continue;
        isNamed[vertex] = true;
        ++result;
    }
    return result;
}

} // namespace osgSkin
