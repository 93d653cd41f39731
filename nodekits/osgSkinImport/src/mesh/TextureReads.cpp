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
    std::string what = "texture \"" + first + '"';
    if (missing > 1) what = std::to_string(missing) + " textures, \"" + first + "\" among them,";
    const auto reason = _reasons.find(first);
    tellOf(_path, what + " cannot be read; drawn without" +
                      (reason == _reasons.end() ? "" : ": " + reason->second));
}

} // namespace osgSkin
