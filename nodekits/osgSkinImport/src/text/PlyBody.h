// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PLYBODY_H
#define OSGSKINIMPORT_PLYBODY_H 1

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

/// What a PLY file's header says about its content.
struct PlyHeader {
    struct Property {
        std::size_t bytes = 0;      ///< of a value, or of a list's entries
        std::size_t countBytes = 0; ///< of a list's length; 0: no list
        bool countIsSigned = false;
    };
    struct Element {
        std::string name;
        double count = 0.0;
        std::vector<Property> properties;
    };
    enum class Format { Text, LittleEndian, BigEndian };
    Format format = Format::Text;
    std::vector<Element> elements;
};

/// Checks that each list is as long as it says: Assimp 5.2.5 asks for the memory first.
/// \param body all that comes after the header
/// \throw osgSkin::Error naming the element. A body that is merely cut short is left to Assimp
void checkPlyLists(const std::string& path, const PlyHeader& header, std::string_view body);

} // namespace osgSkin

#endif
