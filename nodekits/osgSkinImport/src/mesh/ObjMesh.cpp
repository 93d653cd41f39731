// SPDX-License-Identifier: MIT
#include "mesh/MeshFiles.h"

#include "mesh/Material.h"
#include "text/FileText.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

constexpr std::size_t kLongestName = 4000; ///< of a material or a file; the rest is cut off
constexpr std::size_t kMaxLibraries = 1000;
constexpr std::size_t kMaxCorners = 255;       ///< per face
constexpr std::size_t kSamplesOfObjMaterial = 20; ///< each takes two or three kilobytes

// Lines and words of OBJ and MTL files.

/// A byte 0 ends a line, as it ends a string in C.
constexpr bool endsLine(char c) {
    return c == '\n' || c == '\r' || c == '\0';
}

constexpr bool isBlank(char c) {
    return c == ' ' || c == '\t';
}

/// The length of the text before the first character for which `ends` is true. This runs on every
/// line; std::string_view::find_first_of() takes twice as long.
template <typename Ends>
std::size_t lengthUpTo(std::string_view text, const Ends& ends) {
    return static_cast<std::size_t>(std::find_if(text.begin(), text.end(), ends) - text.begin());
}

/// Removes the next line from `text`; it ends with LF, CR, both, or a byte 0.
std::string_view takeLine(std::string_view& text) {
    const std::string_view line = text.substr(0, lengthUpTo(text, endsLine));
    text.remove_prefix(line.size());
    text.remove_prefix(text.substr(0, 2) == "\r\n" ? 2 : std::min<std::size_t>(1, text.size()));
    return line;
}

/// Removes the next word from `line`; empty at the end.
std::string_view takeWord(std::string_view& line) {
    line.remove_prefix(lengthUpTo(line, [](char c) { return !isBlank(c); }));
    const std::string_view word = line.substr(0, lengthUpTo(line, isBlank));
    line.remove_prefix(word.size());
    return word;
}

/// The name in the rest of a line; it may contain blanks.
std::string_view nameIn(std::string_view rest) {
    const std::size_t first = std::min(rest.size(), rest.find_first_not_of(" \t"));
    return rest.substr(first, rest.find_last_not_of(" \t") + 1 - first).substr(0, kLongestName);
}

/// Like parseNumber(), but sums the digits of ordinary decimals one by one, which may round the
/// last bit differently. The border of a skin region can depend on that bit; this keeps the
/// binding, elastic shapes and images of existing characters.
bool readDecimal(std::string_view word, double& value) {
    constexpr std::size_t mostDigits = 32;
    if (!parseNumber(word, value)) return false;
    if (std::abs(value) <= 1e-300) value = 0.0; // without a sign
    if (word.size() > mostDigits || !(std::abs(value) > 1e-300 && std::abs(value) < 1e300))
        return true;
    const auto isDigit = [&](std::size_t at) {
        return at < word.size() && word[at] >= '0' && word[at] <= '9';
    };
    const bool hasSign = word[0] == '+' || word[0] == '-';
    std::size_t at = hasSign ? 1 : 0;
    double sum = 0.0;
    for (; isDigit(at); ++at) sum = sum * 10.0 + (word[at] - '0');
    if (at < word.size() && word[at] == '.') {
        constexpr double tenths[] = {1.0, 0.1, 0.01, 0.001, 0.0001, 0.00001, 0.000001, 0.0000001};
        for (std::size_t place = 1; isDigit(++at); ++place)
            sum += (word[at] - '0') *
                   (place < std::size(tenths) ? tenths[place] : std::pow(10.0, -double(place)));
    }
    int exponent = 0;
    if (at + 1 < word.size() && (word[at] == 'e' || word[at] == 'E')) {
        const std::size_t digits = at + (word[at + 1] == '+' ? 2 : 1);
        std::from_chars(word.data() + digits, word.data() + word.size(), exponent);
    }
    if (exponent != 0) sum = std::ldexp(sum * std::pow(5.0, exponent), exponent);
    value = word[0] == '-' ? -sum : sum;
    return true;
}

/// The array that a line of an OBJ file adds to, in the order of v/vt/vn; -1: none of these.
constexpr int kindOf(std::string_view keyword) {
    return keyword == "v" ? 0 : keyword == "vt" ? 1 : keyword == "vn" ? 2 : -1;
}

/// Whether a backslash at the end of a line with this keyword continues the line.
constexpr bool isContinued(std::string_view keyword) {
    return keyword == "f" || kindOf(keyword) >= 0;
}

/// Calls `use(keyword, rest of the line, line number)` for each line that is not empty, with
/// continued lines joined.
template <typename Use>
void forEachLine(std::string_view text, const Use& use) {
    text.remove_prefix(byteOrderMark(text));
    std::string joined;
    std::size_t lines = 1;
    for (std::size_t number = 1; !text.empty(); number += lines) {
        std::string_view line = takeLine(text);
        lines = 1;
        std::string_view keyword = takeWord(line);
        const std::size_t last = keyword.empty() ? 0 : keyword.size() - 1;
        if (line.empty() && keyword.substr(last) == "\\" && isContinued(keyword.substr(0, last))) {
            line = keyword.substr(last); // the backslash follows the keyword directly
            keyword.remove_suffix(1);
        }
        const bool mayContinue = isContinued(keyword);
        if (mayContinue && !line.empty() && line.back() == '\\') {
            joined.clear();
            for (; !line.empty() && line.back() == '\\'; ++lines) {
                joined.append(line.substr(0, line.size() - 1)) += ' ';
                line = takeLine(text);
            }
            line = joined.append(line);
        }
        if (!keyword.empty()) use(keyword, line, number);
    }
}

// Materials.

using Colour = std::array<double, 3>;

/// A material of a library.
struct MtlMaterial {
    Colour diffuse{0.8, 0.74, 0.68}; ///< the default
    Colour specular{0.0, 0.0, 0.0}, emission{0.0, 0.0, 0.0};
    double dissolve = 1.0, shininess = 1.0;
    std::array<std::string, Material::kMaps> textures;
    bool hasDiffuse = false, hasEmission = false, hasDissolve = false;
};

float upToOne(double number) {
    return static_cast<float>(std::clamp(number, 0.0, 1.0));
}

osg::Vec4 toOsg(const Colour& rgb, double alpha = 1.0) {
    constexpr double brightest = 16.0; // larger values range to 255
    const double one = *std::max_element(rgb.begin(), rgb.end()) > brightest ? 255.0 : 1.0;
    return {upToOne(rgb[0] / one), upToOne(rgb[1] / one), upToOne(rgb[2] / one),
            alpha < 0.0 ? 1.0f : upToOne(alpha)};
}

/// Reads the materials that an OBJ file uses from its libraries. Never fails: lines without the
/// numbers that they need ("Kd spectral x.rfl", "d -halo 0.5") are ignored.
class MtlReader {
public:
    /// \param wanted names of materials
    explicit MtlReader(std::set<std::string, std::less<>> wanted) : _wanted(std::move(wanted)) {}

    /// Reads a library. The first library with a material wins.
    void read(const std::string& path, std::string_view text) {
        _current = nullptr;
        _placed = 0;
        _unused.clear();
        forEachLine(text, [&](std::string_view keyword, std::string_view rest, std::size_t) {
            readLine(keyword, rest);
        });
        if (_placed > 0)
            tellOf(path, "moved or scaled textures (-o, -s): " + std::to_string(_placed) +
                             ", drawn as if they were not");
        tellOfUnusedTextures(path, _unused);
    }

    /// Null if no library so far has the material.
    const MtlMaterial* find(std::string_view name) const {
        const auto found = _materials.find(name);
        return found != _materials.end() ? &found->second : nullptr;
    }

private:
    void readLine(std::string_view keyword, std::string_view rest) {
        const auto is = [&](std::string_view other) { // some files have lower-case keywords
            return keyword.size() == other.size() &&
                   osgDB::equalCaseInsensitive(std::string(keyword), std::string(other));
        };
        if (is("newmtl")) {
            const auto found = _wanted.find(nameIn(rest));
            _current = nullptr;
            if (found == _wanted.end()) return;
            _current = &_materials[*found];
            _wanted.erase(found);
        }
        if (_current == nullptr) return;
        MtlMaterial& material = *_current;
        double number = 0.0;
        if (is("Kd")) {
            if (readColour(rest, material.diffuse)) material.hasDiffuse = true;
        } else if (is("Ks")) {
            readColour(rest, material.specular);
        } else if (is("Ke")) {
            if (readColour(rest, material.emission)) material.hasEmission = true;
        } else if (is("Ns")) {
            if (readNumber(rest, number)) material.shininess = number;
        } else if (is("d")) {
            if (readNumber(rest, number)) {
                material.dissolve = number;
                material.hasDissolve = true;
            }
        } else if (is("Tr")) { // not in the standard: "d" wins
            if (readNumber(rest, number) && !material.hasDissolve) material.dissolve = 1.0 - number;
        } else if (is("map_Kd")) {
            readTextureName(rest, Material::Diffuse, material);
        } else if (is("map_Ke")) {
            readTextureName(rest, Material::Emission, material);
        } else if (is("norm")) {
            readTextureName(rest, Material::Normal, material);
        } else if (!is("map_Ka") && (keyword.substr(0, 4) == "map_" || is("bump"))) {
            ++_unused[std::string(keyword)];
        }
    }

    static bool readNumber(std::string_view rest, double& number) {
        return readDecimal(takeWord(rest), number) && std::isfinite(number);
    }

    /// Reads three numbers, or one for a grey.
    static bool readColour(std::string_view rest, Colour& colour) {
        Colour result{};
        std::string_view first;
        for (std::size_t k = 0; k < 3; ++k) {
            std::string_view word = takeWord(rest);
            if (k == 0) first = word;
            if (!readDecimal(word.empty() ? first : word, result[k]) || !std::isfinite(result[k]))
                return false;
        }
        colour = result;
        return true;
    }

    /// Reads options, then a file name up to the end of the line.
    void readTextureName(std::string_view rest, Material::Map map, MtlMaterial& material) {
        bool isPlaced = false;
        for (std::string_view behind = rest;; rest = behind) {
            const std::string_view option = takeWord(behind);
            const bool isOffset = option == "-o", isScale = option == "-s";
            if (isOffset || isScale || option == "-t") {
                for (int k = 0; k < 3; ++k) {
                    std::string_view next = behind;
                    double number = 0.0;
                    if (!parseNumber(takeWord(next), number)) break;
                    if (!std::isfinite(number)) return;
                    behind = next;
                    isPlaced =
                        isPlaced || (isOffset && number != 0.0) || (isScale && number != 1.0);
                }
                continue;
            }
            static const std::set<std::string_view> oneWord{
                "-blendu", "-blendv",     "-boost",   "-bm",     "-cc",
                "-clamp",  "-colorspace", "-imfchan", "-texres", "-type"};
            const int words = option == "-mm" ? 2 : oneWord.count(option) > 0 ? 1 : 0;
            if (words == 0) break;
            for (int k = 0; k < words; ++k) takeWord(behind);
        }
        const std::string_view name = nameIn(rest);
        if (name.empty()) return;
        if (isPlaced) ++_placed;
        material.textures[map] = name;
        constexpr double underTexture = 0.6;
        if (map == Material::Diffuse && !material.hasDiffuse)
            material.diffuse = {underTexture, underTexture, underTexture};
        if (map == Material::Emission && !material.hasEmission) material.emission = {1.0, 1.0, 1.0};
    }

    std::set<std::string, std::less<>> _wanted; ///< not found in any library so far
    std::map<std::string, MtlMaterial, std::less<>> _materials;
    MtlMaterial* _current = nullptr; ///< described by the current lines; null if not wanted
    std::size_t _placed = 0;
    std::map<std::string, std::size_t> _unused; ///< textures, by keyword
};

// Vertices and faces.

constexpr std::array<const char*, 3> kKinds{"vertex", "texture coordinate", "normal"};

/// Whether a word is infinity or NaN, as some C libraries print them.
bool isBroken(std::string_view word, double value) {
    return word.find("#IND") != std::string_view::npos ||
           word.find("#QNAN") != std::string_view::npos ||
           word.find("#INF") != std::string_view::npos || std::isnan(value) ||
           std::abs(value) >= 1e300;
}

/// Whether a word resembles a keyword of a vertex or face: in upper case, or with invisible
/// characters, such as a byte order mark in concatenated files.
bool looksLikeKeyword(std::string_view word) {
    std::string seen;
    for (const char c : word) {
        if (c > ' ' && c < 0x7f)
            seen += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        else if (!seen.empty())
            break;
    }
    return seen != word && (kindOf(seen) >= 0 || seen == "f" || seen == "fo");
}

class ObjReader {
public:
    ObjReader(const std::string& path, const osgDB::Options* options)
        : _path(path), _options(options), _limits(ReadLimits::of(options)) {}

    CornerMesh run() {
        const std::string text = readText(_path, _limits);
        MtlReader materials(lookAhead(text));
        _library = &materials;
        forEachLine(text, [&](std::string_view keyword, std::string_view rest, std::size_t number) {
            _line = number;
            readLine(keyword, rest);
        });
        return finish();
    }

private:
    /// Zero-based indices of a corner; -1: none.
    struct Corner {
        std::int32_t texCoord = -1, normal = -1;
    };

    /// Counts vertices, because faces may use later ones, and returns the names of used materials.
    std::set<std::string, std::less<>> lookAhead(std::string_view text) {
        std::set<std::string, std::less<>> materials;
        forEachLine(text, [&](std::string_view keyword, std::string_view rest, std::size_t) {
            const int kind = kindOf(keyword);
            if (kind >= 0)
                ++_total[static_cast<std::size_t>(kind)];
            else if (keyword == "usemtl" && materials.find(nameIn(rest)) == materials.end())
                materials.emplace(nameIn(rest));
        });
        if (*std::max_element(_total.begin(), _total.end()) > 0x7fffffff)
            failFile(_path, "more vertices than 32-bit indices reach");
        const std::size_t most = _limits.samplesOf(text.size()) / kSamplesOfObjMaterial;
        if (materials.size() > most)
            failFile(_path, std::to_string(materials.size()) + " materials, expected at most " +
                                std::to_string(most) + " (option maxSamples)");
        return materials;
    }

    void readLine(std::string_view keyword, std::string_view rest) {
        const int kind = kindOf(keyword);
        if (kind >= 0)
            addNumbers(keyword, rest);
        else if (keyword == "f" || keyword == "fo") // the name in version 1 of the format
            addFace(rest);
        else if (keyword == "usemtl")
            useMaterial(nameIn(rest));
        else if (keyword == "mtllib" && !nameIn(rest).empty() && _libraries.emplace(rest).second)
            readLibrary(nameIn(rest));
        else if (looksLikeKeyword(keyword))
            failLine(_path, _line,
                     inQuotes(keyword) +
                         " begins a line, expected \"v\", \"vt\", \"vn\" or \"f\", and a blank");
    }

    void addNumbers(std::string_view keyword, std::string_view rest) {
        const std::size_t expected = keyword == "vt" ? 1 : 3;
        std::array<double, 7> numbers{}; // a position, a weight and a colour
        std::size_t count = 0;
        for (; count < numbers.size(); ++count) {
            const std::string_view word = takeWord(rest);
            double& value = numbers[count];
            const bool isNumber = readDecimal(word, value);
            if (isBroken(word, value)) {
                // A broken normal is no reason to refuse a body: all normals are computed then.
                value = 0.0;
                if (keyword != "v") continue;
            } else if (isNumber) {
                continue;
            }
            if (count >= expected) break;
            failLine(_path, _line,
                     (word.empty() ? "nothing" : inQuotes(word)) + std::string(" in a \"") +
                         std::string(keyword) + "\" line, expected " + std::to_string(expected) +
                         " finite numbers");
        }
        if (keyword == "vt") {
            _texCoords.emplace_back(numbers[0], numbers[1]);
        } else if (keyword == "vn") {
            _normals.emplace_back(numbers[0], numbers[1], numbers[2]);
        } else {
            _mesh.mesh.positions.emplace_back(numbers[0], numbers[1], numbers[2]);
            const bool hasWeight = count == 4 || count == 7;
            if (hasWeight && numbers[3] != 1.0) ++_weighted;
            if (count < 6) return;
            // A colour after the position is not in the standard, but common.
            const double* const rgb = &numbers[hasWeight ? 4 : 3];
            if (_colours.size() + 1 == _mesh.mesh.positions.size())
                _colours.emplace_back(rgb[0], rgb[1], rgb[2], 1.0);
            ++_coloured;
        }
    }

    void addFace(std::string_view rest) {
        _mesh.addFace(materialNumber());
        std::uint32_t& corners = _mesh.mesh.faceSizes.back();
        for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
            if (word.front() == '#') break; // a comment
            // Some programs write "1//" for a corner without a normal.
            const std::string_view whole = word.substr(0, word.find_last_not_of('/') + 1);
            const bool isShort = word.size() - whole.size() <= 2 && !whole.empty();
            addCorner(isShort ? whole : word);
            ++corners;
        }
        if (corners < 3 || corners > kMaxCorners)
            failLine(_path, _line,
                     "a face with " + std::to_string(corners) + " corners, expected 3 to " +
                         std::to_string(kMaxCorners));
    }

    void addCorner(std::string_view word) {
        std::string_view rest = word;
        std::array<std::int32_t, 3> indices{-1, -1, -1};
        for (std::size_t kind = 0; kind < 3; ++kind) {
            const std::size_t slash = rest.find('/');
            const std::string_view digits = rest.substr(0, slash);
            const bool mayBeEmpty = kind == 1 && slash != std::string_view::npos;
            if (!(digits.empty() && mayBeEmpty)) indices[kind] = index(digits, kind, word);
            if (slash == std::string_view::npos) {
                _mesh.mesh.faceVertices.push_back(static_cast<std::uint32_t>(indices[0]));
                _corners.push_back({indices[1], indices[2]});
                return;
            }
            rest.remove_prefix(slash + 1);
        }
        failLine(_path, _line, inQuotes(word) + " in a face, expected v, v/vt, v//vn or v/vt/vn");
    }

    std::int32_t index(std::string_view digits, std::size_t kind, std::string_view word) const {
        long long value = 0;
        const char* const end = digits.data() + digits.size();
        const auto [stop, status] = std::from_chars(digits.data(), end, value);
        const std::array<std::size_t, 3> known{_mesh.mesh.positions.size(), _texCoords.size(),
                                               _normals.size()};
        const auto total = static_cast<long long>(_total[kind]);
        const auto soFar = static_cast<long long>(known[kind]);
        if (status == std::errc() && stop == end) {
            if (value >= 1 && value <= total) return static_cast<std::int32_t>(value - 1);
            if (value <= -1 && value >= -soFar) return static_cast<std::int32_t>(soFar + value);
        }
        failLine(_path, _line,
                 inQuotes(word) + " in a face, expected a " + kKinds[kind] + " from 1 to " +
                     std::to_string(total) + " or from -" + std::to_string(soFar) + " to -1");
    }

    void useMaterial(std::string_view name) {
        const MtlMaterial* const found = _library->find(name);
        if (found == nullptr && !name.empty() && _missing.emplace(name).second)
            _warnings.push_back("material " + inQuotes(name) + " is in no material library");
        _material = found;
    }

    /// The index of the current material, in the order in which faces use them.
    std::uint32_t materialNumber() {
        const auto [entry, isNew] =
            _materials.emplace(_material, static_cast<std::uint32_t>(_materialOrder.size()));
        if (isNew) _materialOrder.push_back(_material);
        return entry->second;
    }

    /// The libraries that a line may name: one file whose name is the whole line, with blanks or
    /// another system's separators, if it exists; otherwise one per word.
    std::vector<std::string> libraryPaths(std::string_view line) const {
        const std::string folder = osgDB::getFilePath(_path);
        const auto inFolder = [&](const std::string& name) {
            return folder.empty() || osgDB::isAbsolutePath(name) ? name
                                                                 : osgDB::concatPaths(folder, name);
        };
        const std::string name(line);
        for (const std::string& whole : {name, osgDB::convertFileNameToUnixStyle(name)})
            if (isRegularFile(inFolder(whole))) return {inFolder(whole)};
        std::vector<std::string> result;
        for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line))
            result.push_back(inFolder(std::string(word)));
        return result;
    }

    /// Reads the first readable library of a line, each file once. A missing library is not an
    /// error: the body is drawn in the default colour.
    void readLibrary(std::string_view line) {
        if (_libraries.size() > kMaxLibraries)
            failLine(_path, _line,
                     "one more material library, expected at most " +
                         std::to_string(kMaxLibraries));
        for (const std::string& path : libraryPaths(line)) {
            std::error_code missing;
            const std::filesystem::path whole = std::filesystem::canonical(path, missing);
            if (!missing && !_read.insert(whole.string()).second) return;
            try {
                _library->read(path, readText(path, _limits));
                return;
            } catch (const Error& error) {
                _warnings.push_back(error.what());
            }
        }
    }

    CornerMesh finish() {
        if (!_warnings.empty())
            tellOf(_path, _warnings.front() +
                              (_warnings.size() > 1
                                   ? " (and " + std::to_string(_warnings.size() - 1) + " more)"
                                   : ""));
        const std::string vertices =
            " of " + std::to_string(_mesh.mesh.positions.size()) + " vertices have ";
        const bool hasColours = _coloured > 0 && _coloured == _mesh.mesh.positions.size();
        if (!hasColours && _coloured > 0)
            tellOf(_path, std::to_string(_coloured) + vertices + "colours, which are left out");
        // Some programs divide the position by it; to others it is a grey level, or a scan's
        // quality.
        if (_weighted > 0)
            tellOf(_path, std::to_string(_weighted) + vertices +
                              "a fourth number that is not 1; it is left out");
        for (std::size_t c = 0; c < _corners.size(); ++c) {
            const auto [texCoord, normal] = _corners[c];
            _mesh.hasTexCoords = _mesh.hasTexCoords || texCoord >= 0;
            _mesh.texCoords.push_back(texCoord >= 0 ? _texCoords[static_cast<std::size_t>(texCoord)]
                                                    : glm::vec2(0.0f));
            _mesh.normals.push_back(normal >= 0 ? _normals[static_cast<std::size_t>(normal)]
                                                : glm::vec3(0.0f));
            if (hasColours) _mesh.colours.push_back(_colours[_mesh.mesh.faceVertices[c]]);
        }
        TextureReads reads(_path, _options);
        for (const MtlMaterial* source : _materialOrder)
            _mesh.stateSets.push_back(makeStateSet(materialOf(source, hasColours, reads)));
        return std::move(_mesh);
    }

    Material materialOf(const MtlMaterial* source, bool hasColours, TextureReads& reads) const {
        Material material;
        material.vertexColours = hasColours;
        if (source == nullptr) return material;
        material.diffuse = toOsg(source->diffuse, source->dissolve);
        material.specular = toOsg(source->specular);
        material.emission = toOsg(source->emission);
        material.shininess = static_cast<float>(source->shininess);
        for (std::size_t map = 0; map < Material::kMaps; ++map)
            material.textures[map].image =
                readTexture(source->textures[map], _path, _options, reads);
        // Without its texture, the colour would make the whole surface glow.
        if (!source->textures[Material::Emission].empty() &&
            !material.textures[Material::Emission].image)
            material.emission = Material().emission;
        return material;
    }

    const std::string& _path;
    const osgDB::Options* _options;
    const ReadLimits _limits;
    std::array<std::size_t, 3> _total{}; ///< vertices, texture coordinates, normals in the file
    std::vector<glm::vec2> _texCoords;
    std::vector<glm::vec3> _normals;
    std::vector<glm::vec4> _colours; ///< of the vertices before the first without one
    std::vector<Corner> _corners;
    std::size_t _line = 0, _coloured = 0, _weighted = 0;

    MtlReader* _library = nullptr;
    const MtlMaterial* _material = nullptr; ///< of the next faces; null: the default
    std::set<std::string_view> _libraries;  ///< lines that name libraries
    std::set<std::string> _read;            ///< libraries, by canonical path
    std::map<const MtlMaterial*, std::uint32_t> _materials;
    std::vector<const MtlMaterial*> _materialOrder;
    std::set<std::string, std::less<>> _missing;
    std::vector<std::string> _warnings;
    CornerMesh _mesh;
};

} // namespace

CornerMesh readObjMesh(const std::string& path, const osgDB::Options* options) {
    return ObjReader(path, options).run();
}

} // namespace osgSkin
