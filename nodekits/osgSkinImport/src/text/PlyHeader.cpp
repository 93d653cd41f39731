// SPDX-License-Identifier: MIT
#include "text/PlyHeader.h"

#include "text/ByteOrderMark.h"
#include "text/FileText.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string_view>

namespace osgSkin {
namespace {

struct NamedType {
    const char* name;
    PlyHeader::Type type;
};

constexpr PlyHeader::Kind kSigned = PlyHeader::Kind::Signed;
constexpr PlyHeader::Kind kUnsigned = PlyHeader::Kind::Unsigned;
constexpr PlyHeader::Kind kFloating = PlyHeader::Kind::Floating;
constexpr NamedType kTypes[] = {
    {"char", {kSigned, 1}},      {"int8", {kSigned, 1}},      {"uchar", {kUnsigned, 1}},
    {"uint8", {kUnsigned, 1}},   {"short", {kSigned, 2}},     {"int16", {kSigned, 2}},
    {"ushort", {kUnsigned, 2}},  {"uint16", {kUnsigned, 2}},  {"int", {kSigned, 4}},
    {"int32", {kSigned, 4}},     {"uint", {kUnsigned, 4}},    {"uint32", {kUnsigned, 4}},
    {"float", {kFloating, 4}},   {"float32", {kFloating, 4}}, {"double", {kFloating, 8}},
    {"float64", {kFloating, 8}},
};

// Others have ten and, where they hold splats, sixty; each is compared with all.
constexpr std::size_t kMostElements = 100;
constexpr std::size_t kMostProperties = 1000; ///< of an element

/// Reads line by line; a line ends with LF, CR or both.
class PlyHeaderReader {
public:
    PlyHeaderReader(const std::string& path, const std::string& text) : _path(path), _text(text) {}

    PlyHeader run() {
        std::string first = nextLine();
        first.erase(first.find_last_not_of(" \t") + 1); // as in other lines
        if (first != "ply") failLine(_path, 1, "expected \"ply\"");
        for (;;) {
            if (_at >= _text.size())
                failFile(_path, "the header has no end, expected a line \"end_header\"");
            const std::string line = nextLine();
            std::istringstream words(line);
            std::string keyword;
            words >> keyword;
            if (keyword == "end_header") break;
            if (keyword == "format")
                readFormat(words);
            else if (keyword == "element")
                readElement(words);
            else if (keyword == "property")
                readProperty(words);
            else if (keyword == "comment")
                readComment(words);
            else
                checkRemark(keyword);
        }
        if (!_hasFormat) failFile(_path, "the header has no line \"format\"");
        _header.end = _at;
        // Each entry takes a byte at least.
        for (std::size_t e = 0; e < _header.elements.size(); ++e)
            if (_header.elements[e].count > _text.size() - _at + 1)
                failLine(_path, _elementLines[e],
                         inQuotes(std::to_string(_header.elements[e].count)) +
                             " elements, expected no more than the file has room for");
        return std::move(_header);
    }

private:
    std::string nextLine() {
        ++_line;
        const std::size_t end = std::min(_text.find_first_of("\r\n", _at), _text.size());
        std::string line = _text.substr(_at, end - _at);
        // Where lines end with CR alone, the LF behind the last one is the body's first byte.
        if (_line == 1) _endsWithCr = _text.compare(end, 1, "\r") == 0 && _text[end + 1] != '\n';
        const bool two = !_endsWithCr && _text.compare(end, 2, "\r\n") == 0;
        _at = end + (two ? 2 : end < _text.size() ? 1 : 0);
        return line;
    }

    void readFormat(std::istream& words) {
        std::string name, version;
        words >> name >> version;
        if (name == "ascii")
            _header.format = PlyHeader::Format::Text;
        else if (name == "binary_little_endian")
            _header.format = PlyHeader::Format::LittleEndian;
        else if (name == "binary_big_endian")
            _header.format = PlyHeader::Format::BigEndian;
        else
            failLine(_path, _line,
                     inQuotes(name) + " is no format, expected ascii, "
                                      "binary_little_endian or binary_big_endian");
        if (_hasFormat) failLine(_path, _line, "a second format");
        _hasFormat = true;
    }

    void readElement(std::istream& words) {
        PlyHeader::Element element;
        std::string count;
        words >> element.name >> count;
        double number = 0.0;
        if (!parseNumber(count, number) || number != std::floor(number))
            failLine(_path, _line, inQuotes(count) + " elements, expected a whole number");
        if (!(number >= 0.0 && number <= double(_text.size())))
            failLine(_path, _line,
                     inQuotes(count) + " elements, expected no more than the file has room for");
        element.count = static_cast<std::size_t>(number);
        if (_header.elements.size() >= kMostElements)
            failLine(_path, _line,
                     "one of more than " + std::to_string(kMostElements) + " elements");
        for (const PlyHeader::Element& known : _header.elements)
            if (known.name == element.name)
                failLine(_path, _line, "a second element " + inQuotes(element.name));
        _header.elements.push_back(element);
        _elementLines.push_back(_line);
    }

    PlyHeader::Type type(const std::string& name) {
        for (const NamedType& known : kTypes)
            if (name == known.name) return known.type;
        std::string names;
        for (const NamedType& known : kTypes)
            names += (names.empty() ? "" : ", ") + std::string(known.name);
        failLine(_path, _line,
                 inQuotes(name) + " is no type of a property, expected one of " + names);
    }

    void readProperty(std::istream& words) {
        if (_header.elements.empty()) failLine(_path, _line, "a property of no element");
        PlyHeader::Property property;
        std::string name;
        words >> name;
        if (name == "list") {
            words >> name;
            property.count = type(name);
            if (property.count->kind == kFloating)
                failLine(_path, _line,
                         inQuotes(name) + " counts no entries, expected a whole number");
            words >> name;
        }
        property.type = type(name);
        words >> property.name;
        PlyHeader::Element& element = _header.elements.back();
        if (property.name.empty()) failLine(_path, _line, "a property without a name");
        if (element.properties.size() >= kMostProperties)
            failLine(_path, _line,
                     "one of more than " + std::to_string(kMostProperties) + " properties of " +
                         inQuotes(element.name));
        if (element.find({property.name.c_str()}))
            failLine(_path, _line,
                     "a second property " + inQuotes(property.name) + " of " +
                         inQuotes(element.name));
        element.properties.push_back(property);
    }

    /// Other lines are remarks (Blender 2.4's have no keyword), but not where one is misspelt: rows
    /// would be longer than what is known of them.
    void checkRemark(std::string keyword) {
        const std::string word = keyword;
        for (char& c : keyword) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        for (const char* known : {"element", "property"})
            if (keyword.compare(0, 4, known, 4) == 0)
                failLine(_path, _line,
                         inQuotes(word) + " begins no line, expected " + inQuotes(known));
    }

    void readComment(std::istream& words) {
        std::string keyword;
        words >> keyword >> std::ws;
        if (keyword != "TextureFile") return;
        std::string texture;
        std::getline(words, texture);
        if (!texture.empty()) _header.textures.push_back(texture);
    }

    const std::string& _path;
    const std::string& _text;
    std::size_t _at = byteOrderMark(_text), _line = 0;
    bool _hasFormat = false, _endsWithCr = false;
    PlyHeader _header;
    std::vector<std::size_t> _elementLines;
};

} // namespace

std::optional<std::size_t> PlyHeader::Element::find(const std::vector<const char*>& names) const {
    for (const char* wanted : names)
        for (std::size_t p = 0; p < properties.size(); ++p)
            if (properties[p].name == wanted) return p;
    return std::nullopt;
}

PlyHeader readPlyHeader(const std::string& path, const std::string& text) {
    return PlyHeaderReader(path, text).run();
}

} // namespace osgSkin
