// SPDX-License-Identifier: MIT
#include "text/ObjCheck.h"

#include "text/ByteOrderMark.h"
#include "text/FileText.h"

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

constexpr std::string_view kLineEnds("\n\r\0", 3);
constexpr std::size_t kLongestName = 4000;
constexpr std::size_t kMostDigits = 32;     // that are taken over as they stand
constexpr std::size_t kLongestKeyword = 16; // longer ones are none of MTL's
constexpr std::size_t kLongestOption = 400;
constexpr std::size_t kMostNumbers = 7; // a place and a colour, or with a weight
constexpr std::size_t kPlaceAndColour = 6;
constexpr std::size_t kPlaceAndWeight = 4;
constexpr std::size_t kMostLibraries = 1000; // which are looked for one by one
constexpr std::size_t mostCorners = 255;     // tinyobjloader counts them in a byte

/// Takes the next word off `line`; empty at its end.
std::string_view takeWord(std::string_view& line) {
    const std::size_t start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos) return line = {};
    line.remove_prefix(start);
    const std::string_view word = line.substr(0, line.find_first_of(" \t"));
    line.remove_prefix(word.size());
    return word;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = std::min(text.size(), text.find_first_not_of(" \t"));
    return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

/// A material's name, which may have blanks: tinyobjloader would take a face's for the first word.
std::string materialName(std::string_view rest) {
    std::string name;
    for (const char c : trimmed(rest).substr(0, kLongestName))
        if (c == ' ' || c == '\t')
            name += "\xc2\xa0"; // a blank that no word ends at
        else
            name += c;
    return name;
}

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

/// Whether tinyobjloader's power of ten stays a number.
bool isInRange(double value) {
    return std::abs(value) > 1e-300 && std::abs(value) < 1e300;
}

/// Adds a number as it stands; one that tinyobjloader would overflow at as 0, and one of more
/// digits than it keeps apart in its shortest form.
void addNumber(std::string_view word, double value, std::string& out) {
    out += ' ';
    if (!isInRange(value)) {
        out += '0';
    } else if (word.size() <= kMostDigits) {
        out += word;
    } else {
        std::array<char, 32> digits;
        const char* const end =
            std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        out.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
    }
}

/// What an OBJ face refers to, in the order of a corner's v/vt/vn.
struct Counts {
    std::array<std::size_t, 3> of{};
};
constexpr std::array<const char*, 3> kinds{"vertex", "texture coordinate", "normal"};

int kindOf(std::string_view keyword) {
    return keyword == "v" ? 0 : keyword == "vt" ? 1 : keyword == "vn" ? 2 : -1;
}

std::string_view takeLine(std::string_view& text) {
    // What C takes for the end of a text ends a line here.
    const std::string_view line = text.substr(0, text.find_first_of(kLineEnds));
    text.remove_prefix(line.size());
    text.remove_prefix(text.substr(0, 2) == "\r\n" ? 2 : std::min<std::size_t>(1, text.size()));
    return line;
}

/// Calls `use(keyword, rest of the line, line number)` for each line that has a keyword. A
/// backslash at its end, of numbers or corners, goes on with the next.
template <typename Use>
void forEachLine(std::string_view text, const Use& use) {
    text.remove_prefix(byteOrderMark(text));
    std::string joined;
    std::size_t lines = 1;
    for (std::size_t number = 1; !text.empty(); number += lines) {
        std::string_view line = takeLine(text);
        lines = 1;
        const std::string_view keyword = takeWord(line);
        const bool mayGoOn = keyword == "f" || kindOf(keyword) >= 0;
        if (mayGoOn && !line.empty() && line.back() == '\\') {
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

/// What Microsoft's and other libraries write for what is no number, or has none.
bool isBroken(std::string_view word, double value) {
    return word.find("#IND") != std::string_view::npos ||
           word.find("#QNAN") != std::string_view::npos ||
           word.find("#INF") != std::string_view::npos || std::isnan(value) ||
           std::abs(value) >= 1e300;
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
        } else if (keyword == "f") {
            keep(keyword, face(rest));
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
        double last = 1.0;
        for (; k < kMostNumbers; ++k) {
            const std::string_view word = takeWord(rest);
            double value = 0.0;
            const bool isNumber = parseNumber(word, value), broken = isBroken(word, value);
            // A body is drawn well enough without a broken normal: all are computed then.
            const bool isFine = broken ? keyword != "v" : isNumber;
            if (isFine) {
                last = broken ? 0.0 : value;
                addNumber(word, last, _checked);
            }
            if (!isFine && k >= expected) break;
            if (isFine) continue;
            failLine(_path, _line,
                     (word.empty() ? "nothing" : inQuotes(word)) + std::string(" in a \"") +
                         std::string(keyword) + "\" line, expected " + std::to_string(expected) +
                         " finite numbers");
        }
        if (keyword == "v" && k >= kPlaceAndColour) ++_coloured;
        if (keyword == "v" && k == kPlaceAndWeight && last != 1.0) ++_weighted;
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

/// Whether an option among the words is a number that tinyobjloader would overflow at.
bool hasOverflow(std::string_view words) {
    for (std::string_view word = takeWord(words); !word.empty(); word = takeWord(words)) {
        double value = 0.0;
        if (!parseNumber(word, value)) continue;
        if (word.size() >= kLongestOption || (value != 0.0 && !isInRange(value))) return true;
    }
    return false;
}

/// Whether a texture's options move it, or scale it.
bool isPlaced(std::string_view words) {
    std::string_view option;
    for (std::string_view word = takeWord(words); !word.empty(); word = takeWord(words)) {
        double value = 0.0;
        if (!parseNumber(word, value))
            option = word;
        else if ((option == "-o" && value != 0.0) || (option == "-s" && value != 1.0))
            return true;
    }
    return false;
}

/// Keywords of material libraries that are used, and how many numbers follow; 0: a file's name.
struct MtlKeyword {
    const char* name;
    std::size_t numbers;
};
constexpr MtlKeyword kMtlKeywords[] = {{"newmtl", 0}, {"Kd", 3}, {"Ks", 3}, {"Ke", 3},
                                       {"Ns", 1},     {"d", 1},  {"Tr", 1}, {"map_Kd", 0}};

/// What a material is drawn with that says none, as one that no library has.
constexpr const char* kUnknownColour = "Kd 0.8 0.74 0.68\n";

} // namespace

CheckedMtl checkMtl(std::string_view text, std::set<std::string>& wanted) {
    CheckedMtl result;
    std::string& checked = result.text;
    bool isWanted = false, hasColour = true;
    const auto finish = [&] { // tinyobjloader's own default is black
        if (!hasColour) checked += kUnknownColour;
        hasColour = true;
    };
    forEachLine(text, [&](std::string_view given, std::string_view rest, std::size_t) {
        const std::string keyword(given.substr(0, kLongestKeyword)); // some write small letters
        if (osgDB::equalCaseInsensitive(keyword, "newmtl")) {
            finish();
            isWanted = wanted.erase(materialName(rest)) > 0;
            hasColour = !isWanted;
        }
        if (!isWanted) return;
        for (const MtlKeyword& known : kMtlKeywords) {
            if (!osgDB::equalCaseInsensitive(keyword, known.name)) continue;
            std::string line(known.name);
            bool hasNumbers = true;
            std::string_view first;
            for (std::size_t k = 0; k < known.numbers; ++k) {
                std::string_view word = takeWord(rest);
                if (k == 0) first = word;
                if (word.empty()) word = first; // the one number of a grey
                double value = 0.0;
                hasNumbers = hasNumbers && parseNumber(word, value) && std::isfinite(value);
                addNumber(word, value, line);
            }
            // "Kd spectral x.rfl", "d -halo 0.5": better as if it were not there than black, or
            // gone.
            if (!hasNumbers || (known.numbers == 0 && hasOverflow(rest))) continue;
            const std::string_view name = known.name;
            hasColour = hasColour || name == "Kd" || name == "map_Kd";
            if (name == "newmtl")
                line += ' ' + materialName(rest);
            else if (known.numbers == 0)
                line += rest.substr(0, kLongestName);
            if (name == "map_Kd" && isPlaced(rest)) ++result.placedTextures;
            checked += line + '\n';
        }
    });
    finish();
    return result;
}

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
