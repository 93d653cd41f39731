// SPDX-License-Identifier: MIT
#include "text/wavefront/ObjCheck.h"

#include "text/FileText.h"
#include "text/wavefront/ObjLines.h"

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <set>
#include <string_view>
#include <utility>

namespace osgSkin {
namespace {

constexpr std::size_t kMostNumbers = 7; // a place and a colour, or with a weight
constexpr std::size_t kPlaceAndColour = 6;
constexpr std::size_t kPlaceAndWeight = 4;
constexpr std::size_t kMostLibraries = 1000; // which are looked for one by one
constexpr std::size_t mostCorners = 255;     // tinyobjloader counts them in a byte

/// The libraries that a line names, as tinyobjloader takes them apart: one, where there is a file
/// of the whole name, with blanks or another system's separators.
std::string libraryNames(std::string_view rest, const std::string& folder) {
    std::string name(trimmed(rest).substr(0, kLongestName));
    for (const std::string& whole : {name, osgDB::convertFileNameToUnixStyle(name)}) {
        if (!isRegularFile(folder.empty() || osgDB::isAbsolutePath(whole)
                               ? whole
                               : osgDB::concatPaths(folder, whole)))
            continue;
        std::string escaped;
        for (const char c : whole) {
            if (c == ' ' || c == '\\') escaped += '\\';
            escaped += c;
        }
        return escaped;
    }
    return name;
}

/// What an OBJ face refers to, in the order of a corner's v/vt/vn.
struct Counts {
    std::array<std::size_t, 3> of{};
};
constexpr std::array<const char*, 3> kinds{"vertex", "texture coordinate", "normal"};

/// What Microsoft's and other libraries write for what is no number, or has none.
bool isBroken(std::string_view word, double value) {
    return word.find("#IND") != std::string_view::npos ||
           word.find("#QNAN") != std::string_view::npos ||
           word.find("#INF") != std::string_view::npos || std::isnan(value) ||
           std::abs(value) >= 1e300;
}

/// Whether a word is a vertex's or a face's keyword to the eye alone: in capitals, or with signs
/// that no one sees, as a byte order mark that joined files leave.
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

class Checker {
public:
    Checker(const std::string& path, const Counts& total) : _path(path), _total(total) {}

    void line(std::string_view keyword, std::string_view rest, std::size_t number) {
        _line = number;
        const int kind = kindOf(keyword);
        if (kind >= 0) {
            ++_soFar.of[static_cast<std::size_t>(kind)];
            numbers(keyword, rest);
        } else if (keyword == "f" || keyword == "fo") { // its name in the format's first version
            keep("f", face(rest));
        } else if (keyword == "usemtl") {
            const std::string name = materialName(rest);
            keep(keyword, ' ' + name);
            _materials.insert(name);
        } else if (keyword == "mtllib" && !rest.empty() && _libraries.emplace(rest).second) {
            if (_libraries.size() > kMostLibraries)
                failLine(_path, _line,
                         "one more material library, expected at most " +
                             std::to_string(kMostLibraries));
            keep(keyword, ' ' + libraryNames(rest, osgDB::getFilePath(_path)));
        } else if (looksLikeKeyword(keyword)) {
            failLine(_path, _line,
                     inQuotes(keyword) +
                         " begins a line, expected \"v\", \"vt\", \"vn\" or \"f\", and a blank");
        }
    }

    CheckedObj take() { return {std::move(_checked), std::move(_materials), _coloured, _weighted}; }

private:
    void keep(std::string_view keyword, std::string_view rest) {
        _checked.append(keyword).append(rest) += '\n';
    }

    void numbers(std::string_view keyword, std::string_view rest) {
        const std::size_t expected = keyword == "vt" ? 1 : 3;
        _checked.append(keyword);
        std::size_t k = 0;
        double weight = 1.0;
        std::size_t weightAt = 0, weightEnd = 0;
        for (; k < kMostNumbers; ++k) {
            const std::string_view word = takeWord(rest);
            double value = 0.0;
            const bool isNumber = parseNumber(word, value), broken = isBroken(word, value);
            // A body is drawn well enough without a broken normal: all are computed then.
            const bool isFine = broken ? keyword != "v" : isNumber;
            if (isFine) {
                const std::size_t at = _checked.size();
                addNumber(word, broken ? 0.0 : value, _checked);
                if (k + 1 == kPlaceAndWeight) {
                    weight = broken ? 0.0 : value;
                    weightAt = at;
                    weightEnd = _checked.size();
                }
            }
            if (!isFine && k >= expected) break;
            if (isFine) continue;
            failLine(_path, _line,
                     (word.empty() ? "nothing" : inQuotes(word)) + std::string(" in a \"") +
                         std::string(keyword) + "\" line, expected " + std::to_string(expected) +
                         " finite numbers");
        }
        if (keyword == "v" && k >= kPlaceAndColour) ++_coloured;
        const bool all = k == kMostNumbers; // a place, its weight and a colour
        if (keyword == "v" && (all || k == kPlaceAndWeight) && weight != 1.0) ++_weighted;
        // tinyobjloader takes the weight for red.
        if (keyword == "v" && all) _checked.erase(weightAt, weightEnd - weightAt);
        _checked += '\n';
    }

    /// A face's corners as tinyobjloader reads them: some write "1//" of one without a normal.
    std::string face(std::string_view rest) const {
        std::size_t corners = 0;
        std::string checked;
        for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
            if (word.front() == '#') break; // a comment
            const std::string_view whole = word.substr(0, word.find_last_not_of('/') + 1);
            const bool isShort = word.size() - whole.size() <= 2 && !whole.empty();
            corner(isShort ? whole : word);
            checked += ' ';
            checked += whole;
            ++corners;
        }
        if (corners < 3 || corners > mostCorners)
            failLine(_path, _line,
                     "a face with " + std::to_string(corners) + " corners, expected 3 to " +
                         std::to_string(mostCorners));
        return checked;
    }

    void corner(std::string_view word) const {
        std::string_view rest = word;
        for (std::size_t kind = 0; kind < 3; ++kind) {
            const std::size_t slash = rest.find('/');
            const std::string_view digits = rest.substr(0, slash);
            const bool mayBeEmpty = kind == 1 && slash != std::string_view::npos;
            if (!(digits.empty() && mayBeEmpty)) index(digits, kind, word);
            if (slash == std::string_view::npos) return;
            rest.remove_prefix(slash + 1);
        }
        failLine(_path, _line, inQuotes(word) + " in a face, expected v, v/vt, v//vn or v/vt/vn");
    }

    void index(std::string_view digits, std::size_t kind, std::string_view word) const {
        long long value = 0;
        const char* const end = digits.data() + digits.size();
        const auto [stop, status] = std::from_chars(digits.data(), end, value);
        const auto total = static_cast<long long>(_total.of[kind]);
        const auto soFar = static_cast<long long>(_soFar.of[kind]);
        const bool fits = status == std::errc() && stop == end &&
                          ((value >= 1 && value <= total) || (value <= -1 && value >= -soFar));
        if (!fits)
            failLine(_path, _line,
                     inQuotes(word) + " in a face, expected a " + kinds[kind] + " from 1 to " +
                         std::to_string(total) + " or from -" + std::to_string(soFar) + " to -1");
    }

    const std::string& _path;
    const Counts& _total;
    Counts _soFar;
    std::set<std::string_view> _libraries; ///< of materials: each is read once
    std::set<std::string> _materials;
    std::string _checked;
    std::size_t _line = 0, _coloured = 0, _weighted = 0;
};

} // namespace

CheckedObj checkObj(const std::string& path, std::string_view text) {
    Counts total;
    forEachLine(text, [&](std::string_view keyword, std::string_view, std::size_t) {
        const int kind = kindOf(keyword);
        if (kind >= 0) ++total.of[static_cast<std::size_t>(kind)];
    });
    if (total.of[0] > 0x7fffffff / 3) failFile(path, "more vertices than 32-bit indices reach");
    Checker checker(path, total);
    forEachLine(text, [&](std::string_view keyword, std::string_view rest, std::size_t number) {
        checker.line(keyword, rest, number);
    });
    return checker.take();
}

} // namespace osgSkin
