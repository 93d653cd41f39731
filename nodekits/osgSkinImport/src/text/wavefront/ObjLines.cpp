// SPDX-License-Identifier: MIT
#include "text/wavefront/ObjLines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace osgSkin {
namespace {

constexpr std::size_t kMostDigits = 32; // that are taken over as they stand

/// 0 is what C takes for the end of a text.
constexpr bool endsLine(char c) {
    return c == '\n' || c == '\r' || c == '\0';
}

constexpr bool isBlank(char c) {
    return c == ' ' || c == '\t';
}

/// The length of the text's beginning without what `ends`. In a file's every line: searching for
/// one of several letters by std::string_view's own means takes twice as long.
template <typename Ends>
std::size_t lengthUpTo(std::string_view text, const Ends& ends) {
    return static_cast<std::size_t>(std::find_if(text.begin(), text.end(), ends) - text.begin());
}

} // namespace

std::string_view takeLine(std::string_view& text) {
    const std::string_view line = text.substr(0, lengthUpTo(text, endsLine));
    text.remove_prefix(line.size());
    text.remove_prefix(text.substr(0, 2) == "\r\n" ? 2 : std::min<std::size_t>(1, text.size()));
    return line;
}

std::string_view takeWord(std::string_view& line) {
    line.remove_prefix(lengthUpTo(line, [](char c) { return !isBlank(c); }));
    const std::string_view word = line.substr(0, lengthUpTo(line, isBlank));
    line.remove_prefix(word.size());
    return word;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = std::min(text.size(), text.find_first_not_of(" \t"));
    return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

std::string materialName(std::string_view rest) {
    std::string name;
    for (const char c : trimmed(rest).substr(0, kLongestName))
        if (isBlank(c))
            name += "\xc2\xa0"; // a blank that no word ends at
        else
            name += c;
    return name;
}

bool isInRange(double value) {
    return std::abs(value) > 1e-300 && std::abs(value) < 1e300;
}

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

} // namespace osgSkin
