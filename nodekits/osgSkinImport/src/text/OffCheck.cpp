// SPDX-License-Identifier: MIT
#include "text/OffCheck.h"

#include "text/FileText.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace osgSkin {
namespace {

/// The words that a file begins with, as Assimp divides them: it takes CR and form feeds for ends
/// of lines, too, and comments end there.
std::vector<std::string_view> firstWords(std::string_view text, std::size_t most) {
    constexpr std::string_view lineEnds("\n\r\f\0", 4);
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < text.size() && words.size() < most;) {
        const char c = text[at];
        if (c == '#') {
            at = text.find_first_of(lineEnds, at);
        } else if (c == ' ' || c == '\t' || lineEnds.find(c) != std::string_view::npos) {
            ++at;
        } else {
            const std::size_t end =
                std::min(text.size(), text.find_first_of(std::string_view("\n\r\f\0 \t#", 7), at));
            words.push_back(text.substr(at, end - at));
            at = end;
        }
    }
    return words;
}

bool isDigits(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Whether a word is [ST][C][N][4][n]OFF.
bool isKeyword(std::string_view word) {
    for (const std::string_view part : {"ST", "C", "N", "4", "n"})
        if (word.substr(0, part.size()) == part) word.remove_prefix(part.size());
    return word == "OFF";
}

} // namespace

void checkOff(const std::string& path, const std::string& text) {
    std::vector<std::string_view> words = firstWords(text, 4);
    const bool hasKeyword = !words.empty() && isKeyword(words.front());
    // Without the keyword Assimp takes a file's first digit for one of its marks.
    if (!hasKeyword)
        failFile(path, inQuotes(std::string(words.empty() ? "" : words.front())) +
                           ", expected OFF, or STOFF, COFF, NOFF, ...");
    const bool hasDimension =
        words.front().size() > 3 && words.front()[words.front().size() - 4] == 'n';
    const std::size_t counts = hasDimension ? 2 : 1;
    for (std::size_t i = 1; i < counts + 2; ++i) {
        const std::string word(i < words.size() ? words[i] : "");
        const bool isVertices = i == counts;
        // Assimp reads the digits that a word begins with.
        if (!isDigits(word))
            failFile(path, inQuotes(word) + ", expected a number of " +
                               (i < counts   ? "dimensions"
                                : isVertices ? "vertices"
                                             : "faces"));
        // Each vertex and each face takes a few characters.
        double count = 0.0;
        parseNumber(word, count);
        if (i >= counts && count > double(text.size()))
            failFile(path, inQuotes(word) + (isVertices ? " vertices" : " faces") +
                               ", expected no more than the file has room for");
    }
}

} // namespace osgSkin
