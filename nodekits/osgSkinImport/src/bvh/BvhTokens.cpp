// SPDX-License-Identifier: MIT
#include "bvh/BvhTokens.h"

#include "text/FileText.h"

#include <osgSkin/GlmTypes>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

// The locale has no say in what a file holds, so <cctype> is not used.
bool isBlank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

} // namespace

std::string described(std::string_view word) {
    return word.empty() ? "the end of the file" : inQuotes(word);
}

bool isSameWord(std::string_view a, std::string_view b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                              [](char x, char y) { return lower(x) == lower(y); });
}

const char* parseFinite(std::string_view word, double& value) {
    if (!parseNumber(word, value) || !std::isfinite(value)) return "a finite number";
    return std::abs(value) <= kLargestCoordinate ? nullptr : "a number from -1e18 to 1e18";
}

BvhTokens::BvhTokens(const std::string& path, std::string_view text) : _path(path), _rest(text) {
    const std::string_view byteOrderMark = "\xef\xbb\xbf";
    if (_rest.substr(0, byteOrderMark.size()) == byteOrderMark)
        _rest.remove_prefix(byteOrderMark.size());
    // What old systems end a text with.
    while (!_rest.empty() && (_rest.back() == '\0' || _rest.back() == '\x1a'))
        _rest.remove_suffix(1);
}

void BvhTokens::skipBlanks() {
    std::size_t start = 0;
    for (; start < _rest.size() && isBlank(_rest[start]); ++start) {
        const bool lonely = start + 1 == _rest.size() || _rest[start + 1] != '\n';
        if (_rest[start] == '\n' || (_rest[start] == '\r' && lonely)) ++_line;
    }
    _rest.remove_prefix(start);
}

std::string_view BvhTokens::take(std::size_t length) {
    const std::string_view result = _rest.substr(0, length);
    _rest.remove_prefix(length);
    return result;
}

std::string_view BvhTokens::next() {
    skipBlanks();
    if (_rest.empty()) return {};
    std::size_t length = 1;
    if (_rest[0] != '{' && _rest[0] != '}')
        while (length < _rest.size() && !isBlank(_rest[length]) && _rest[length] != '{' &&
               _rest[length] != '}')
            ++length;
    return take(length);
}

void BvhTokens::expect(std::string_view word) {
    skipBlanks();
    const std::size_t length = word.size();
    const bool ends = _rest.size() <= length || !isLetter(word.back()) || !isLetter(_rest[length]);
    if (ends && isSameWord(_rest.substr(0, length), word)) {
        take(length);
        return;
    }
    fail("found " + described(next()) + ", expected " + inQuotes(word));
}

std::string_view BvhTokens::jointName() {
    skipBlanks();
    std::size_t length = std::min(_rest.find_first_of("{\r\n"), _rest.size());
    while (length > 0 && isBlank(_rest[length - 1])) --length;
    if (length == 0 || _rest[0] == '}')
        fail("found " + described(next()) + ", expected a joint's name");
    return take(length);
}

void BvhTokens::skipName() {
    take(std::min(_rest.find_first_of("{}\r\n"), _rest.size()));
}

bool BvhTokens::isAtLineEnd() {
    const std::size_t before = _line;
    const std::string_view rest = _rest;
    skipBlanks();
    const bool result = _rest.empty() || _line != before;
    _line = before;
    _rest = rest;
    return result;
}

double BvhTokens::number(const std::string& what) {
    const std::string_view word = next();
    double value = 0.0;
    if (const char* expected = parseFinite(word, value))
        fail(what + " is " + described(word) + ", expected " + expected);
    return value;
}

std::size_t BvhTokens::count(const std::string& what, std::size_t largest) {
    const std::string_view word = next();
    double value = 0.0;
    if (!parseNumber(word, value) || !(value >= 0.0 && value <= static_cast<double>(largest)) ||
        value != std::floor(value))
        fail(what + " is " + described(word) + ", expected a whole number from 0 to " +
             std::to_string(largest));
    return static_cast<std::size_t>(value);
}

void BvhTokens::fail(const std::string& message) const {
    failLine(_path, _line, message);
}

} // namespace osgSkin
