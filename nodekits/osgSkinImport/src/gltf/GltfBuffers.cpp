// SPDX-License-Identifier: MIT
#include "gltf/GltfBuffers.h"

namespace osgSkin {

GltfBuffers::Layout GltfBuffers::layout() const {
    Layout result;
    std::map<const std::string*, std::size_t> known;
    for (const Content& content : _contents) {
        if (content == nullptr) {
            result.begins.push_back(0);
            continue;
        }
        const auto [entry, isNew] = known.emplace(content.get(), result.size);
        result.begins.push_back(entry->second);
        if (isNew) result.size += (content->size() + 3) / 4 * 4;
    }
    return result;
}

void GltfBuffers::append(std::string& bytes) const {
    const Layout all = layout();
    const std::size_t start = bytes.size();
    bytes.reserve(start + all.size);
    for (std::size_t i = 0; i < _contents.size(); ++i) {
        // One that is there already, or nothing.
        if (!isThere(i) || start + all.begins[i] != bytes.size()) continue;
        bytes += *_contents[i];
        bytes.resize((bytes.size() - start + 3) / 4 * 4 + start, '\0');
    }
}

} // namespace osgSkin
