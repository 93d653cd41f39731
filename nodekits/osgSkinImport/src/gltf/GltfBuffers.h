// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GLTFBUFFERS_H
#define OSGSKINIMPORT_GLTFBUFFERS_H 1

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {

/// What a glTF file's buffers hold, by their indices. Several may share a content, which is there
/// once; some are not there, as those that stand in for compressed ones.
class GltfBuffers {
public:
    using Content = std::shared_ptr<const std::string>; ///< null: not there

    void add(Content content) { _contents.push_back(std::move(content)); }

    bool isThere(std::size_t buffer) const {
        return buffer < _contents.size() && _contents[buffer] != nullptr;
    }
    std::size_t count() const { return _contents.size(); }
    std::size_t sizeOf(std::size_t buffer) const {
        return isThere(buffer) ? _contents[buffer]->size() : 0;
    }

    /// A buffer that isThere(); stays where it is while others are added.
    const std::string& operator[](std::size_t buffer) const { return *_contents[buffer]; }

    /// Where each content begins when all are written one after another, at multiples of four
    /// bytes.
    struct Layout {
        std::vector<std::size_t> begins; ///< of each buffer
        std::size_t size = 0;            ///< in all
    };
    Layout layout() const;

    /// Writes them as layout() says.
    void append(std::string& bytes) const;

private:
    std::vector<Content> _contents;
};

} // namespace osgSkin

#endif
