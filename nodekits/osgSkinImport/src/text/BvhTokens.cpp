// SPDX-License-Identifier: MIT
#include "text/BvhTokens.h"

#include "text/FileText.h"

#include <cmath>

namespace osgSkin {
namespace {

constexpr std::string_view whitespace = " \t\n\r\v\f";

} // namespace

std::string described(std::string_view word) {
    return word.empty() ? "the end of the file" : quoted(word);
}

std::string_view BvhTokens::next() {
    std::size_t start = 0;
    while (start < _rest.size() && whitespace.find(_rest[start]) != std::string_view::npos)
        if (_rest[start++] == '\n') ++_line;
    _rest.remove_prefix(start);
    if (_rest.empty()) return {};
    std::size_t length = _rest.find_first_of(whitespace);
    if (_rest[0] == '{' || _rest[0] == '}') length = 1;
    const std::string_view word = _rest.substr(0, length);
    _rest.remove_prefix(word.size());
    return word;
}

void BvhTokens::expect(std::string_view word) {
    const std::string_view found = next();
    if (found != word) fail("found " + described(found) + ", expected " + quoted(word));
}

double BvhTokens::number(const std::string& what) {
    const std::string_view word = next();
    double value = 0.0;
    if (!parseNumber(word, value) || !std::isfinite(value))
        fail(what + " is " + described(word) + ", expected a finite number");
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
