// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PLYHEADER_H
#define OSGSKINIMPORT_PLYHEADER_H 1

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// What a PLY file's header says about its content.
struct PlyHeader {
    enum class Kind { Signed, Unsigned, Floating };
    struct Type {
        Kind kind = Kind::Signed;
        std::size_t bytes = 1;
    };
    struct Property {
        std::string name;
        Type type;                 ///< of the value, or of a list's entries
        std::optional<Type> count; ///< of a list's length
    };
    struct Element {
        std::string name;
        std::size_t count = 0;
        std::vector<Property> properties;

        /// The place of the first of some properties; none where the element has none of them.
        std::optional<std::size_t> find(const std::vector<const char*>& names) const;
    };
    enum class Format { Text, LittleEndian, BigEndian };
    Format format = Format::Text;
    std::vector<Element> elements; ///< each name once, of no more entries than the file has bytes
    std::vector<std::string> textures; ///< each "comment TextureFile" names one
    std::size_t end = 0;               ///< where the content begins
};

/// Reads the header of a PLY file.
/// \throw osgSkin::Error "PATH: line N: what was expected".
PlyHeader readPlyHeader(const std::string& path, const std::string& text);

} // namespace osgSkin

#endif
