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
    // Programs write these parts in more orders than one; a vertex' numbers stand in one.
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

} // namespace osgSkin
