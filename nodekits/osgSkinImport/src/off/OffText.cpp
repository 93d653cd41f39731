// SPDX-License-Identifier: MIT
#include "off/OffText.h"

#include "text/ByteOrderMark.h"

#include <algorithm>

namespace osgSkin {
namespace {

constexpr std::string_view kOffLineEnds = "\n\r";
constexpr std::string_view kBlanks = " \t\v";
constexpr std::string_view kBlanksAndLineEnds = " \t\v\n\r";
constexpr std::string_view kWordEnds = " \t\v\n\r#";

} // namespace

bool OffKind::read(std::string_view word) {
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

} // namespace osgSkin
