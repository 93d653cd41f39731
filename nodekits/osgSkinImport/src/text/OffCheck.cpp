// SPDX-License-Identifier: MIT
#include "text/OffCheck.h"

#include "text/ByteOrderMark.h"
#include "text/FileText.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// A file's words and lines as Assimp divides it: it takes CR for the end of a line, too, and
/// comments of the head end there.
class OffText {
public:
    explicit OffText(std::string_view text) : _rest(text) {}

    /// The next word of the head; empty at the end.
    std::string_view word() {
        skipToWord();
        return take(_rest.find_first_of("\n\r \t#"));
    }
    void skipToWord() {
        while (!_rest.empty()) {
            if (_rest.front() == '#')
                take(_rest.find_first_of(kLineEnds));
            else if (std::string_view("\n\r \t").find(_rest.front()) != std::string_view::npos)
                _rest.remove_prefix(1);
            else
                return;
        }
    }
    /// The words of the next line of the body; none at the end.
    std::vector<std::string_view> line() {
        std::string_view line = take(_rest.find_first_of(kLineEnds));
        _rest.remove_prefix(std::min(_rest.size(), _rest.find_first_not_of(kLineEnds)));
        std::vector<std::string_view> words;
        if (line.size() >= kLongestLine) return words;
        for (std::size_t at = 0;
             (at = line.find_first_not_of(" \t", at)) != std::string_view::npos;) {
            const std::size_t end = std::min(line.size(), line.find_first_of(" \t", at));
            words.push_back(line.substr(at, end - at));
            at = end;
        }
        return words;
    }

private:
    static constexpr std::string_view kLineEnds = "\n\r";
    static constexpr std::size_t kLongestLine = 4096; ///< that Assimp takes for one

    std::string_view take(std::size_t length) {
        const std::string_view taken = _rest.substr(0, length);
        _rest.remove_prefix(taken.size());
        return taken;
    }

    std::string_view _rest;
};

bool isDigits(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// What the first word, [ST][C][N][4][n]OFF, says of vertices.
struct OffKind {
    bool texCoords = false, colours = false, normals = false, divided = false, dimensions = false;

    /// False where a word is none.
    bool read(std::string_view word) {
        const auto take = [&](std::string_view part) {
            const bool has = word.substr(0, part.size()) == part;
            if (has) word.remove_prefix(part.size());
            return has;
        };
        texCoords = take("ST");
        colours = take("C");
        normals = take("N");
        divided = take("4");
        dimensions = take("n");
        return word == "OFF";
    }
};

/// A text with some of its parts replaced, which are given in their order.
class Replaced {
public:
    explicit Replaced(std::string_view text) : _rest(text) {}

    void replace(std::string_view part, std::string_view by) {
        _done.append(_rest.data(), part.data()).append(by);
        _rest.remove_prefix(static_cast<std::size_t>(part.data() + part.size() - _rest.data()));
    }
    std::string take() { return std::move(_done.append(_rest)); }

private:
    std::string_view _rest;
    std::string _done;
};

/// Writes a long number, at whose digits Assimp overflows, as a float.
void shorten(std::string_view word, Replaced& text) {
    constexpr std::size_t kMostDigits = 18;
    double number = 0.0;
    if (word.size() <= kMostDigits || !parseNumber(word, number)) return;
    std::array<char, 32> digits;
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(number));
    text.replace(word, {digits.data(), static_cast<std::size_t>(end.ptr - digits.data())});
}

bool isVertex(const std::vector<std::string_view>& words) {
    double number = 0.0;
    return words.size() >= 3 && std::all_of(words.begin(), words.begin() + 3,
                                            [&](auto word) { return parseNumber(word, number); });
}

bool isFace(const std::vector<std::string_view>& words, std::size_t vertices) {
    double corners = 0.0, index = 0.0;
    if (words.empty() || !isDigits(words[0]) || !parseNumber(words[0], corners) ||
        !(corners >= 1.0 && corners <= 8.0 && double(words.size()) > corners))
        return false;
    return std::all_of(words.begin() + 1, words.begin() + 1 + static_cast<int>(corners),
                       [&](std::string_view word) {
                           return isDigits(word) && parseNumber(word, index) &&
                                  index < double(vertices);
                       });
}

} // namespace

std::string checkOff(const std::string& path, const std::string& text) {
    if (text.find('\0') != std::string::npos) failFile(path, "a zero byte, expected text");
    // Assimp takes it for the end of some lines, and not of others.
    if (text.find('\f') != std::string::npos) failFile(path, "a form feed, expected lines of text");
    const std::string_view all = std::string_view(text).substr(byteOrderMark(text));
    OffText off(all);
    Replaced checked(all);
    const std::string_view keyword = off.word();
    // Without the keyword Assimp takes a file's first digit for one of its marks.
    OffKind kind;
    if (!kind.read(keyword))
        failFile(path,
                 inQuotes(std::string(keyword)) + ", expected OFF, or STOFF, COFF, NOFF, ...");
    const auto count = [&](const char* what) {
        const std::string word(off.word());
        double number = 0.0;
        // Assimp reads the digits that a word begins with.
        if (!isDigits(word) || !parseNumber(word, number))
            failFile(path, inQuotes(word) + ", expected a number of " + what);
        // Each vertex and each face takes a few characters.
        if (number > double(text.size()))
            failFile(path,
                     inQuotes(word) + " " + what + ", expected no more than the file has room for");
        return static_cast<std::size_t>(number);
    };
    // Assimp takes a normal's last number for the colour's first, and computes normals where the
    // file has none.
    const bool dropsNormals = kind.normals && (kind.colours || kind.texCoords);
    if (dropsNormals) checked.replace(keyword.substr(keyword.find('N'), 1), "");
    const std::size_t dimensions = kind.dimensions ? count("dimensions") : 3;
    const std::size_t normal = dimensions + (kind.divided ? 1 : 0);
    const std::size_t vertices = count("vertices"), faces = count("faces");
    count("edges");
    off.skipToWord();
    for (std::size_t i = 0; i < vertices; ++i) {
        const std::vector<std::string_view> words = off.line();
        const std::size_t least = dropsNormals ? std::max<std::size_t>(3, normal + 3) : 3;
        if (!isVertex(words) || words.size() < least)
            failFile(path, "vertex " + std::to_string(i) + ": expected a line of " +
                               (least == 3 ? "three" : std::to_string(least)) + " numbers or more");
        for (std::size_t k = 0; k < words.size(); ++k)
            if (dropsNormals && k >= normal && k < normal + 3)
                checked.replace(words[k], "");
            else
                shorten(words[k], checked);
    }
    // What it takes for no face Assimp counts off more faces than there are.
    for (std::size_t i = 0; i < faces; ++i)
        if (!isFace(off.line(), vertices))
            failFile(path, "face " + std::to_string(i) +
                               ": expected a line with 1 to 8 and so many numbers below " +
                               std::to_string(vertices));
    return checked.take();
}

} // namespace osgSkin
