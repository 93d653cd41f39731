// SPDX-License-Identifier: MIT
#include "mesh/MeshFiles.h"

#include "files/FileText.h"
#include "mesh/Material.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace osgSkin {

namespace {

/// The vertex attributes declared by the first word of an OFF file, [ST][C][N][4][n]OFF.
struct OffKind {
    bool texCoords = false, colours = false, normals = false, divided = false, dimensions = false;

    /// Parses the word; false if it is not such a keyword.
    bool read(std::string_view word);
};

/// Splits an OFF file into words and lines. Comments run from "#" to the end of the line. A line
/// ends with LF, CR or both.
class OffText {
public:
    explicit OffText(std::string_view text);

    /// The next word, on any line; empty at the end.
    std::string_view word();

    /// The words of the next line that is not empty, or the rest of the line that word() read from.
    const std::vector<std::string_view>& line();

private:
    void skip(std::string_view characters);

    std::string_view _rest;
    std::vector<std::string_view> _words;
};

constexpr std::string_view kOffLineEnds = "\n\r";
constexpr std::string_view kBlanks = " \t\v";
constexpr std::string_view kBlanksAndLineEnds = " \t\v\n\r";
constexpr std::string_view kWordEnds = " \t\v\n\r#";

bool OffKind::read(std::string_view word) {
    // Programs write these parts in different orders; the order of a vertex's numbers is fixed.
    const auto take = [&](std::string_view part, bool& has) {
        if (has || word.substr(0, part.size()) != part) return false;
        word.remove_prefix(part.size());
        return has = true;
    };
    texCoords = colours = normals = divided = dimensions = false;
    while (take("ST", texCoords) || take("C", colours) || take("N", normals) ||
           take("4", divided) || take("n", dimensions)) {
    }
    return word == "OFF";
}

OffText::OffText(std::string_view text) : _rest(text.substr(byteOrderMark(text))) {}

void OffText::skip(std::string_view characters) {
    _rest.remove_prefix(std::min(_rest.size(), _rest.find_first_not_of(characters)));
    while (!_rest.empty() && _rest.front() == '#') {
        _rest.remove_prefix(std::min(_rest.size(), _rest.find_first_of(kOffLineEnds)));
        _rest.remove_prefix(std::min(_rest.size(), _rest.find_first_not_of(characters)));
    }
}

std::string_view OffText::word() {
    skip(kBlanksAndLineEnds);
    const std::string_view word = _rest.substr(0, _rest.find_first_of(kWordEnds));
    _rest.remove_prefix(word.size());
    return word;
}

const std::vector<std::string_view>& OffText::line() {
    _words.clear();
    for (std::string_view next = word(); !next.empty(); next = word()) {
        _words.push_back(next);
        skip(kBlanks);
        if (_rest.empty() || kOffLineEnds.find(_rest.front()) != std::string_view::npos) break;
    }
    return _words;
}

const osg::Vec4 kGrey(0.6f, 0.6f, 0.6f, 1.0f);

bool isDigits(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

float singleOf(double number) {
    const bool fits = std::abs(number) <= double(std::numeric_limits<float>::max());
    return fits ? static_cast<float>(number) : std::numeric_limits<float>::infinity();
}

class OffReader {
public:
    OffReader(const std::string& path, const std::string& text)
        : _path(path), _size(text.size()), _text(text) {}

    CornerMesh run() {
        const std::string_view keyword = _text.word();
        if (!_kind.read(keyword))
            failFile(_path, inQuotes(keyword) + ", expected OFF, or STOFF, COFF, NOFF, ...");
        const std::size_t dimensions = _kind.dimensions ? count("dimensions") : 3;
        _normal = dimensions + (_kind.divided ? 1 : 0);
        const std::size_t vertices = count("vertices"), faces = count("faces");
        count("edges");
        for (std::size_t v = 0; v < vertices; ++v) addVertex(v);
        for (std::size_t f = 0; f < faces; ++f) addFace(f);
        if (!_text.word().empty()) warn(_path, "lines after the last face ignored");
        if (_colouredFaces > 0)
            warn(_path, std::to_string(_colouredFaces) + " of " + std::to_string(faces) +
                            " faces have colours, which are left out");
        _mesh.hasTexCoords = _kind.texCoords;
        return std::move(_mesh);
    }

private:
    std::size_t count(const char* what) {
        const std::string_view word = _text.word();
        double number = 0.0;
        if (!isDigits(word) || !parseNumber(word, number))
            failFile(_path, inQuotes(word) + ", expected a number of " + what);
        // Each vertex and each face takes several characters.
        if (number > static_cast<double>(_size))
            failFile(_path, inQuotes(word) + " " + what + ", more than fit in the file");
        return static_cast<std::size_t>(number);
    }

    void addVertex(std::size_t index) {
        std::vector<float>& n = _numbers;
        n.clear();
        double number = 0.0;
        for (const std::string_view word : _text.line())
            if (parseNumber(word, number))
                n.push_back(singleOf(number));
            else
                break;
        const std::size_t behind = _normal + (_kind.normals ? 3 : 0);
        const std::size_t least = std::max<std::size_t>(3, behind);
        if (n.size() < least)
            failFile(_path, "vertex " + std::to_string(index) + ": expected a line of " +
                                (least == 3 ? "three" : std::to_string(least)) +
                                " numbers or more");
        const double by = _kind.divided ? static_cast<double>(n[_normal - 1]) : 1.0;
        _mesh.mesh.positions.emplace_back(double(n[0]) / by, double(n[1]) / by, double(n[2]) / by);
        if (_kind.normals) _normals.emplace_back(n[_normal], n[_normal + 1], n[_normal + 2]);
        const std::size_t end = _kind.texCoords && n.size() >= behind + 2 ? n.size() - 2 : n.size();
        if (_kind.texCoords)
            _texCoords.push_back(end < n.size() ? glm::vec2(n[end], n[end + 1]) : glm::vec2(0.0f));
        if (!_kind.colours) return;
        glm::vec4 colour(1.0f);
        if (end >= behind + 3) // a single number indexes a colour map that is not in the file
            for (std::size_t k = 0; k < 4 && behind + k < end; ++k)
                colour[static_cast<int>(k)] = n[behind + k];
        _colours.push_back(colour);
    }

    void addFace(std::size_t index) {
        const std::size_t vertices = _mesh.mesh.positions.size();
        const std::vector<std::string_view>& words = _text.line();
        const auto fail = [&] {
            failFile(_path, "face " + std::to_string(index) +
                                ": expected the number of its corners and as many vertex "
                                "numbers below " +
                                std::to_string(vertices));
        };
        const auto number = [&](std::string_view word, std::size_t end) {
            double value = 0.0;
            if (!isDigits(word) || !parseNumber(word, value) || !(value < double(end))) fail();
            return static_cast<std::uint32_t>(value);
        };
        if (words.empty()) fail();
        const std::uint32_t corners = number(words[0], words.size());
        if (corners == 0) fail();
        if (words.size() > corners + 1) ++_colouredFaces;
        if (corners >= 3) _mesh.addFace(0);
        for (std::uint32_t k = 1; k <= corners; ++k) {
            const std::uint32_t v = number(words[k], vertices);
            if (corners < 3) continue; // points and lines
            _mesh.addCorner(v, _normals.empty() ? glm::vec3(0.0f) : _normals[v],
                            _texCoords.empty() ? glm::vec2(0.0f) : _texCoords[v]);
            if (!_colours.empty()) _mesh.colours.push_back(_colours[v]);
        }
    }

    const std::string& _path;
    const std::size_t _size;
    OffText _text;
    OffKind _kind;
    std::size_t _normal = 3; ///< index of a vertex's normal, or of what follows
    std::vector<float> _numbers;
    std::vector<glm::vec3> _normals;
    std::vector<glm::vec2> _texCoords;
    std::vector<glm::vec4> _colours;
    std::size_t _colouredFaces = 0;
    CornerMesh _mesh;
};

} // namespace

CornerMesh readOffMesh(const std::string& path, const osgDB::Options* options) {
    const std::string text = readText(path, ReadLimits::of(options));
    if (text.find('\0') != std::string::npos) failFile(path, "a zero byte, expected text");
    // Programs disagree on whether a form feed ends a line.
    if (text.find('\f') != std::string::npos) failFile(path, "a form feed, expected lines of text");
    CornerMesh result = OffReader(path, text).run();
    Material material;
    material.diffuse = kGrey;
    material.vertexColours = !result.colours.empty();
    result.stateSets = {makeStateSet(material)};
    return result;
}

} // namespace osgSkin
