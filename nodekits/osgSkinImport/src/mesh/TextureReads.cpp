// SPDX-License-Identifier: MIT
#include "mesh/TextureReads.h"

#include "text/FileText.h"

#include <osgSkin/Error>

#include <cstddef>

namespace osgSkin {

osg::ref_ptr<osg::Image> TextureReads::once(const std::string& name,
                                            const std::function<osg::ref_ptr<osg::Image>()>& read) {
    const auto [entry, isNew] = _images.emplace(name, nullptr);
    if (!isNew) return entry->second;
    try {
        entry->second = read();
    } catch (const Error& error) {
        _reasons[name] = error.what();
    }
    return entry->second;
}

TextureReads::~TextureReads() {
    std::size_t missing = 0;
    std::string first;
    for (const auto& [name, image] : _images) {
        if (image.valid()) continue;
        if (missing++ == 0) first = name;
    }
    if (missing == 0) return;
    std::string reason;
    if (!_reasons.empty()) {
        first = _reasons.begin()->first;
        reason = ": " + _reasons.begin()->second;
    }
    std::string what = "texture \"" + first + '"';
    if (missing > 1) what = std::to_string(missing) + " textures, \"" + first + "\" among them,";
    tellOf(_path, what + " cannot be read; drawn without" + reason);
}

} // namespace osgSkin
