// SPDX-License-Identifier: MIT
#include "mesh/MeshFiles.h"

#include "files/FileText.h"
#include "mesh/Material.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

namespace {

/// A PLY file's header.
struct PlyHeader {
    enum class Kind { Signed, Unsigned, Floating };
    struct Type {
        Kind kind = Kind::Signed;
        std::size_t bytes = 1;
    };
    struct Property {
        std::string name;
        Type type;                 ///< of the value, or of list entries
        std::optional<Type> count; ///< of a list's length
    };
    struct Element {
        std::string name;
        std::size_t count = 0;
        std::vector<Property> properties;

        /// The index of the first of `names` that is a property; none if there is none.
        std::optional<std::size_t> find(const std::vector<const char*>& names) const;
    };
    enum class Format { Text, LittleEndian, BigEndian };
    Format format = Format::Text;
    std::vector<Element> elements;     ///< unique names; no more entries than the file has bytes
    std::vector<std::string> textures; ///< from each "comment TextureFile"
    std::size_t end = 0;               ///< offset of the body
};

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

// Files usually have ten properties, or sixty with splats; each is compared with all others.
constexpr std::size_t kMaxElements = 100;
constexpr std::size_t kMaxProperties = 1000; ///< per element

/// Parses the header line by line. A line ends with LF, CR or both.
class PlyHeaderReader {
public:
    PlyHeaderReader(const std::string& path, const std::string& text) : _path(path), _text(text) {}

    PlyHeader run() {
        std::string first = nextLine();
        first.erase(first.find_last_not_of(" \t") + 1); // as on other lines
        if (first != "ply") failLine(_path, 1, "expected \"ply\"");
        for (;;) {
            if (_at >= _text.size()) failFile(_path, "the header has no line \"end_header\"");
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
        // Each entry takes at least a byte.
        for (std::size_t e = 0; e < _header.elements.size(); ++e)
            if (_header.elements[e].count > _text.size() - _at + 1)
                failLine(_path, _elementLines[e],
                         inQuotes(std::to_string(_header.elements[e].count)) +
                             " elements, more than fit in the file");
        return std::move(_header);
    }

private:
    std::string nextLine() {
        ++_line;
        const std::size_t end = std::min(_text.find_first_of("\r\n", _at), _text.size());
        std::string line = _text.substr(_at, end - _at);
        // If lines end with CR alone, an LF after the last one is the first byte of the body.
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
                     "unknown format " + inQuotes(name) +
                         ", expected ascii, binary_little_endian or binary_big_endian");
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
            failLine(_path, _line, inQuotes(count) + " elements, more than fit in the file");
        element.count = static_cast<std::size_t>(number);
        if (_header.elements.size() >= kMaxElements)
            failLine(_path, _line, "more than " + std::to_string(kMaxElements) + " elements");
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
                 "unknown property type " + inQuotes(name) + ", expected one of " + names);
    }

    void readProperty(std::istream& words) {
        if (_header.elements.empty()) failLine(_path, _line, "property before any element");
        PlyHeader::Property property;
        std::string name;
        words >> name;
        if (name == "list") {
            words >> name;
            property.count = type(name);
            if (property.count->kind == kFloating)
                failLine(_path, _line,
                         "a list's length has the type " + inQuotes(name) +
                             ", expected an integer type");
            words >> name;
        }
        property.type = type(name);
        words >> property.name;
        PlyHeader::Element& element = _header.elements.back();
        if (property.name.empty()) failLine(_path, _line, "a property without a name");
        if (element.properties.size() >= kMaxProperties)
            failLine(_path, _line,
                     "more than " + std::to_string(kMaxProperties) + " properties of " +
                         inQuotes(element.name));
        if (element.find({property.name.c_str()}))
            failLine(_path, _line,
                     "a second property " + inQuotes(property.name) + " of " +
                         inQuotes(element.name));
        element.properties.push_back(property);
    }

    /// Other lines are ignored as remarks (Blender 2.4 writes them without a keyword), but a
    /// misspelt keyword is refused: the rows of the body would be longer than declared.
    void checkRemark(std::string keyword) {
        const std::string word = keyword;
        for (char& c : keyword) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        for (const char* known : {"element", "property"})
            if (keyword.compare(0, 4, known, 4) == 0)
                failLine(_path, _line,
                         "unknown keyword " + inQuotes(word) + "; did you mean " + inQuotes(known) +
                             "?");
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

std::optional<std::size_t> PlyHeader::Element::find(const std::vector<const char*>& names) const {
    for (const char* wanted : names)
        for (std::size_t p = 0; p < properties.size(); ++p)
            if (properties[p].name == wanted) return p;
    return std::nullopt;
}

/// Reads the header of a PLY file.
/// \throw osgSkin::Error "PATH: line N: what was expected".
PlyHeader readPlyHeader(const std::string& path, const std::string& text) {
    return PlyHeaderReader(path, text).run();
}

/// An entry of an element: for each property its value, or its list of values.
using PlyValues = std::vector<std::vector<double>>;

/// Receives an entry: its element, its index, and its values.
using TakePlyEntry =
    std::function<void(const PlyHeader::Element&, std::size_t index, const PlyValues&)>;

/// A binary body.
class PlyBytes {
public:
    PlyBytes(std::string_view body, bool bigEndian) : _rest(body), _bigEndian(bigEndian) {}

    /// Reads a number; returns null, or an error message.
    const char* read(const PlyHeader::Type& type, double& number) {
        if (_rest.size() < type.bytes) return "the file ends here";
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < type.bytes; ++i)
            bits = bits << 8 | std::uint8_t(_rest[_bigEndian ? i : type.bytes - 1 - i]);
        _rest.remove_prefix(type.bytes);
        number = numberOf(bits, type);
        return nullptr;
    }

    bool hasRoom(double entries, const PlyHeader::Type& type) const {
        return entries >= 0.0 && entries * double(type.bytes) <= double(_rest.size());
    }

    bool isAtEnd() const { return _rest.empty(); }

private:
    static double numberOf(std::uint64_t bits, const PlyHeader::Type& type) {
        if (type.kind == PlyHeader::Kind::Floating) {
            if (type.bytes == 8) return as<double>(bits);
            return double(as<float>(std::uint32_t(bits)));
        }
        const double range = std::ldexp(1.0, int(8 * type.bytes));
        const bool negative = type.kind == PlyHeader::Kind::Signed && double(bits) >= range / 2.0;
        return double(bits) - (negative ? range : 0.0);
    }

    template <typename Number, typename Bits>
    static Number as(Bits bits) {
        static_assert(sizeof(Number) == sizeof(Bits), "the same bytes");
        Number number;
        std::memcpy(&number, &bits, sizeof number);
        return number;
    }

    std::string_view _rest;
    bool _bigEndian;
};

/// A text body; an entry takes at least two characters.
class PlyWords {
public:
    explicit PlyWords(std::string_view body) : _rest(body) {}

    const char* read(const PlyHeader::Type&, double& number) {
        const char* const blank = " \t\r\n";
        const std::size_t begin = _rest.find_first_not_of(blank);
        if (begin == std::string_view::npos) return "the file ends here";
        const std::size_t end = std::min(_rest.find_first_of(blank, begin), _rest.size());
        const bool isNumber = parseNumber(_rest.substr(begin, end - begin), number);
        _rest.remove_prefix(end);
        return isNumber ? nullptr : "not a number";
    }

    bool hasRoom(double entries, const PlyHeader::Type&) const {
        return entries >= 0.0 && 2.0 * entries <= double(_rest.size()) + 1.0;
    }

    bool isAtEnd() const { // some systems end a text with Ctrl-Z
        return _rest.find_first_not_of(std::string_view(" \t\r\n\x1a\0", 6)) == std::string::npos;
    }

private:
    std::string_view _rest;
};

/// A list's length for a message, without decimals if it is an integer.
std::string lengthText(double length) {
    return std::abs(length) < 1e15 && length == std::floor(length)
               ? std::to_string(static_cast<std::int64_t>(length))
               : std::to_string(length);
}

/// Reads all entries; returns whether this consumed the whole body.
template <typename Body>
bool walk(const std::string& path, const PlyHeader& header, Body body, const TakePlyEntry& take) {
    PlyValues values;
    for (const PlyHeader::Element& element : header.elements)
        for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i) {
            const auto fail = [&](const std::string& what) {
                failFile(path,
                         "element \"" + element.name + "\" " + std::to_string(i) + ": " + what);
            };
            values.resize(element.properties.size());
            for (std::size_t p = 0; p < values.size(); ++p) {
                const PlyHeader::Property& property = element.properties[p];
                double entries = 1.0, number = 0.0;
                if (property.count) {
                    if (const char* wrong = body.read(*property.count, entries)) fail(wrong);
                    if (!body.hasRoom(entries, property.type) || entries != std::floor(entries))
                        fail("a list of " + lengthText(entries) +
                             " entries, more than fit in the file");
                }
                values[p].clear();
                for (double k = 0.0; k < entries; k += 1.0) {
                    if (const char* wrong = body.read(property.type, number)) fail(wrong);
                    values[p].push_back(number);
                }
            }
            take(element, i, values);
        }
    return body.isAtEnd();
}

/// Reads a PLY file's body, in the memory of one entry at a time, whatever the header declares.
/// \param path of the file
/// \param header of the file
/// \param body everything after the header
/// \param take receives each entry
/// \throw osgSkin::Error with element and entry, if a number is invalid, a list is longer than the
///        file, or the file ends too soon
void readPlyBody(const std::string& path, const PlyHeader& header, std::string_view body,
                 const TakePlyEntry& take) {
    const bool isText = header.format == PlyHeader::Format::Text;
    const bool isWhole =
        isText ? walk(path, header, PlyWords(body), take)
               : walk(path, header, PlyBytes(body, header.format == PlyHeader::Format::BigEndian),
                      take);
    if (isWhole) return;
    // Rows longer than the header declares would have been read as several.
    if (isText) failFile(path, "more numbers than the header declares");
    warn(path, "trailing bytes ignored");
}

using Column = std::optional<std::size_t>; ///< index of a property

constexpr double kNoTexture = -1.0; ///< for an invalid texture number

/// Finds the value of full colour. The property's type does not determine it: many programs write 0
/// to 255 in any integer type.
struct FullColour {
    bool isWhole = false; ///< an integer type; other types are left unchanged
    double most = 0.0;    ///< the largest number

    void take(double number) { most = std::max(most, number); }

    float number() const {
        if (!isWhole) return 1.0f;
        return most <= 255.0 ? 255.0f : most <= 65535.0 ? 65535.0f : 4294967295.0f;
    }
};

/// Collects vertices and faces from the entries of a file, with elements in any order.
class PlyCollector {
public:
    PlyCollector(const std::string& path, const PlyHeader& header)
        : _path(path), _textureCount(static_cast<double>(header.textures.size())) {
        for (const PlyHeader::Element& element : header.elements) {
            if (element.name == "vertex") findVertexColumns(element);
            if (element.name == "face") {
                _indices = element.find({"vertex_indices", "vertex_index"});
                _cornerTexCoords = element.find({"texcoord"});
                _texture = element.find({"texnumber"});
                if (element.find({"red", "diffuse_red"}))
                    warn(path, "colours of faces are left out");
            }
            if (element.name == "multi_texture_vertex")
                warn(path, "texture coordinates of \"multi_texture_vertex\" are left out");
            if (element.name == "tristrips")
                _strips = element.find({"vertex_indices", "vertex_index"});
        }
    }

    void take(const PlyHeader::Element& element, std::size_t index, const PlyValues& values) {
        if (element.name == "vertex")
            addVertex(values);
        else if (element.name == "face" && _indices)
            addFace(index, values[*_indices],
                    _cornerTexCoords ? values[*_cornerTexCoords] : std::vector<double>(),
                    _texture ? at(values, _texture) : 0.0);
        else if (element.name == "tristrips" && _strips)
            addStrips(values[*_strips]);
    }

    bool hasColours() const { return !_colours.empty(); }

    /// \param addMaterial adds a material with a texture, given by number; returns the material's
    ///        index
    CornerMesh finish(const std::function<std::uint32_t(double)>& addMaterial) {
        CornerMesh result;
        for (glm::vec4& colour : _colours)
            for (int k = 0; k < 4; ++k)
                colour[k] =
                    colour[k] < 0.0f ? 1.0f : colour[k] / _full[std::size_t(k / 3)].number();
        std::map<double, std::uint32_t> materials; // by texture number
        result.mesh.positions = std::move(_positions);
        const std::size_t vertices = result.mesh.positions.size();
        std::size_t corner = 0;
        for (std::size_t f = 0; f < _faceSizes.size(); ++f) {
            const std::uint32_t size = _faceSizes[f];
            const double texture = _textures.empty() ? 0.0 : _textures[f];
            auto material = materials.find(texture);
            if (material == materials.end())
                material = materials.emplace(texture, addMaterial(texture)).first;
            result.addFace(material->second);
            for (std::uint32_t k = 0; k < size; ++k, ++corner) {
                const std::uint32_t v = _corners[corner];
                if (v >= vertices)
                    failFile(_path, "face " + std::to_string(result.mesh.faceSizes.size() - 1) +
                                        " names vertex " + std::to_string(v) +
                                        ", expected less than " + std::to_string(vertices));
                glm::vec2 texCoord(0.0f);
                if (!_faceTexCoords.empty())
                    texCoord = _faceTexCoords[corner];
                else if (!_texCoords.empty())
                    texCoord = _texCoords[v];
                result.addCorner(v, _normals.empty() ? glm::vec3(0.0f) : _normals[v], texCoord);
                if (!_colours.empty()) result.colours.push_back(_colours[v]);
            }
        }
        result.hasTexCoords = !_faceTexCoords.empty() || !_texCoords.empty();
        return result;
    }

private:
    void findVertexColumns(const PlyHeader::Element& element) {
        _x = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
        if (!_x[0] || !_x[1] || !_x[2])
            failFile(_path, "the element \"vertex\" has no properties x, y and z");
        _n = {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
        _t = {element.find({"u", "s", "texture_u"}), element.find({"v", "t", "texture_v"})};
        _c = {element.find({"red", "diffuse_red", "r"}),
              element.find({"green", "diffuse_green", "g"}),
              element.find({"blue", "diffuse_blue", "b"}),
              element.find({"alpha", "diffuse_alpha", "a"})};
        for (std::size_t k = 0; k < 4; ++k) {
            if (!_c[k]) continue;
            const PlyHeader::Type& type = element.properties[*_c[k]].type;
            _full[k / 3].isWhole |= type.kind != PlyHeader::Kind::Floating;
        }
    }

    /// A property's value; the first value of a list.
    static double at(const PlyValues& values, const Column& column) {
        return values[*column].empty() ? 0.0 : values[*column].front();
    }

    void addVertex(const PlyValues& values) {
        _positions.emplace_back(at(values, _x[0]), at(values, _x[1]), at(values, _x[2]));
        if (_n[0] && _n[1] && _n[2])
            _normals.emplace_back(at(values, _n[0]), at(values, _n[1]), at(values, _n[2]));
        if (_t[0] && _t[1]) _texCoords.emplace_back(at(values, _t[0]), at(values, _t[1]));
        if (!_c[0] || !_c[1] || !_c[2]) return;
        glm::vec4 colour(-1.0f); // alpha -1: none, opaque
        for (std::size_t k = 0; k < 4; ++k) {
            if (!_c[k]) continue;
            const double number = at(values, _c[k]);
            colour[int(k)] = static_cast<float>(number < 0.0 ? 0.0 : number);
            _full[k / 3].take(double(colour[int(k)]));
        }
        _colours.push_back(colour);
    }

    std::uint32_t indexOf(double number, const std::string& where) const {
        if (!(number >= 0.0 && number < 4294967295.0) || number != std::floor(number))
            failFile(_path, where + " names vertex " + std::to_string(number) +
                                ", expected one of the file's");
        return static_cast<std::uint32_t>(number);
    }

    void addFace(std::size_t index, const std::vector<double>& corners,
                 const std::vector<double>& texCoords, double texture) {
        if (corners.size() < 3) return; // points and lines
        if (_texture)
            _textures.push_back(texture >= 0.0 && texture < _textureCount ? std::floor(texture)
                                                                          : kNoTexture);
        _faceSizes.push_back(static_cast<std::uint32_t>(corners.size()));
        for (const double corner : corners)
            _corners.push_back(indexOf(corner, "face " + std::to_string(index)));
        if (!_cornerTexCoords) return;
        for (std::size_t k = 0; k < corners.size(); ++k)
            _faceTexCoords.push_back(2 * k + 1 < texCoords.size()
                                         ? glm::vec2(texCoords[2 * k], texCoords[2 * k + 1])
                                         : glm::vec2(0.0f));
    }

    /// Adds triangle strips, separated by negative numbers.
    void addStrips(const std::vector<double>& strip) {
        std::size_t begin = 0;
        for (std::size_t k = 0; k < strip.size(); ++k) {
            if (strip[k] < 0.0) begin = k + 1;
            if (strip[k] < 0.0 || k < begin + 2) continue;
            const bool odd = (k - begin) % 2 != 0;
            _faceSizes.push_back(3);
            if (_texture) _textures.push_back(0.0);
            for (const std::size_t c : {odd ? k - 1 : k - 2, odd ? k - 2 : k - 1, k})
                _corners.push_back(indexOf(strip[c], "a strip"));
            // Other faces may have them.
            if (_cornerTexCoords) _faceTexCoords.resize(_corners.size(), glm::vec2(0.0f));
        }
    }

    const std::string& _path;
    const double _textureCount;
    std::array<Column, 3> _x, _n;
    std::array<Column, 2> _t;
    std::array<Column, 4> _c;
    std::array<FullColour, 2> _full; ///< of red, green and blue; of alpha
    Column _indices, _cornerTexCoords, _texture, _strips;
    std::vector<glm::dvec3> _positions;
    std::vector<glm::vec3> _normals;
    std::vector<glm::vec2> _texCoords, _faceTexCoords;
    std::vector<glm::vec4> _colours;
    std::vector<std::uint32_t> _faceSizes, _corners;
    std::vector<double> _textures; ///< per face: index in the header's textures
};

} // namespace

CornerMesh readPlyMesh(const std::string& path, const osgDB::Options* options) {
    const std::string text = readText(path, ReadLimits::of(options));
    const PlyHeader header = readPlyHeader(path, text);
    PlyCollector collector(path, header);
    readPlyBody(path, header, std::string_view(text).substr(header.end),
                [&](const PlyHeader::Element& element, std::size_t index, const PlyValues& values) {
                    collector.take(element, index, values);
                });
    TextureReads reads(path, options);
    std::vector<osg::ref_ptr<osg::StateSet>> stateSets;
    CornerMesh result = collector.finish([&](double texture) {
        Material material;
        material.vertexColours = collector.hasColours();
        if (texture >= 0.0 && texture < double(header.textures.size()))
            material.textures[Material::Diffuse].image = readTexture(
                header.textures[static_cast<std::size_t>(texture)], path, options, reads);
        stateSets.push_back(makeStateSet(material));
        return static_cast<std::uint32_t>(stateSets.size() - 1);
    });
    result.stateSets = stateSets;
    return result;
}

} // namespace osgSkin
