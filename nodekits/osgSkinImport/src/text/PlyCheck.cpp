// SPDX-License-Identifier: MIT
#include "text/PlyCheck.h"

#include "text/FileText.h"
#include "text/PlyBody.h"

#include <cstddef>
#include <sstream>

namespace osgSkin {
namespace {

struct Type {
    const char* name;
    std::size_t bytes;
    bool isSigned;
};

constexpr Type kTypes[] = {
    {"char", 1, true},  {"int8", 1, true},    {"uchar", 1, false},  {"uint8", 1, false},
    {"short", 2, true}, {"int16", 2, true},   {"ushort", 2, false}, {"uint16", 2, false},
    {"int", 4, true},   {"int32", 4, true},   {"uint", 4, false},   {"uint32", 4, false},
    {"float", 4, true}, {"float32", 4, true}, {"double", 8, true},  {"float64", 8, true},
};

const Type& typeOf(const std::string& path, std::size_t line, const std::string& name) {
    for (const Type& type : kTypes)
        if (name == type.name) return type;
    failLine(path, line, inQuotes(name) + " is no type of a property");
}

void readElement(const std::string& path, std::size_t line, std::istream& words,
                 std::size_t bodySize, PlyHeader& header) {
    PlyHeader::Element element;
    std::string count;
    words >> element.name >> count;
    const bool isNumber = parseNumber(count, element.count);
    // Each element takes a byte at least.
    if (!isNumber || !(element.count >= 0.0 && element.count <= double(bodySize)))
        failLine(path, line,
                 inQuotes(count) + " elements, expected no more than the file has room for");
    header.elements.push_back(element);
}

void readProperty(const std::string& path, std::size_t line, std::istream& words,
                  PlyHeader& header) {
    if (header.elements.empty()) failLine(path, line, "a property of no element");
    PlyHeader::Property property;
    std::string type;
    words >> type;
    if (type == "list") {
        words >> type;
        const Type& count = typeOf(path, line, type);
        property.countBytes = count.bytes;
        property.countIsSigned = count.isSigned;
        if (type == "float" || type == "float32" || count.bytes > 4)
            failLine(path, line, inQuotes(type) + " counts no entries, expected a whole number");
        words >> type;
    }
    property.bytes = typeOf(path, line, type).bytes;
    header.elements.back().properties.push_back(property);
}

} // namespace

void checkPly(const std::string& path, const std::string& text) {
    const std::string mark = "\nend_header";
    const std::size_t end = text.find(mark);
    std::size_t after = end == std::string::npos ? end : end + mark.size();
    if (after == std::string::npos || after >= text.size() ||
        (text[after] != '\n' && text[after] != '\r'))
        failFile(path, "the header has no end, expected a line \"end_header\"");
    after += text.compare(after, 2, "\r\n") == 0 ? 2 : 1;

    PlyHeader header;
    std::istringstream lines(text.substr(0, end));
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        std::istringstream words(line);
        std::string keyword;
        words >> keyword;
        if (keyword == "element")
            readElement(path, number, words, text.size() - after + 1, header);
        else if (keyword == "property")
            readProperty(path, number, words, header);
        else if (keyword == "format" && words >> keyword)
            header.format = keyword == "binary_little_endian" ? PlyHeader::Format::LittleEndian
                            : keyword == "binary_big_endian"  ? PlyHeader::Format::BigEndian
                                                              : PlyHeader::Format::Text;
    }
    checkPlyLists(path, header, std::string_view(text).substr(after));
}

} // namespace osgSkin
