// SPDX-License-Identifier: MIT
#include "Mutator.h"

#include <cctype>
#include <cstring>
#include <utility>

namespace fuzz {
namespace {

const char* const kNumbers[] = {"0",      "-1",         "1",          "1e39",
                                "-1e308", "1e999",      "nan",        "2147483648",
                                "-0",     "4294967295", "4294967296", "18446744073709551615",
                                "0.5",    "65536",      "1e-45",      "99999999999999999999999"};

const std::uint32_t kPatterns[] = {0u,          1u,          0x7fu,       0xffu,       0x7fffu,
                                   0xffffu,     0x10000u,    0x7fffffffu, 0x80000000u, 0xffffffffu,
                                   0x7f800000u, 0x7fc00000u, 0x00000001u, 0x7e967699u, 0xff7fffffu};

} // namespace

Mutator::Mutator(std::vector<std::string> inputs, std::vector<std::string> words,
                 std::size_t longest, std::uint64_t seed)
    : _inputs(std::move(inputs)), _words(std::move(words)), _longest(longest), _random(seed) {
    if (_inputs.empty()) _inputs.emplace_back();
}

std::string Mutator::next() {
    if (_given < _inputs.size()) return _inputs[_given++];
    std::string made = any(_inputs);
    // Mostly a few changes: an input that differs everywhere is refused at its first byte.
    for (std::size_t changes = 1 + below(1 + below(8)); changes > 0; --changes) change(made);
    if (made.size() > _longest) made.resize(_longest);
    return made;
}

void Mutator::change(std::string& input) {
    switch (below(8)) {
    case 0:
        return changeByte(input);
    case 1:
        return changeNumber(input);
    case 2:
        return void(input.erase(below(input.size()), 1 + below(1 + below(64))));
    case 3:
        return putIn(input, piece(input)); // duplicates a part
    case 4:
        return putIn(input, piece(any(_inputs)));
    case 5:
        return putIn(input, _words.empty() ? std::string(1, char(below(256))) : any(_words));
    case 6:
        return void(input.resize(below(input.size() + 1)));
    default:
        if (input.size() < 4) return changeByte(input);
        std::memcpy(&input[below(input.size() - 3)], &kPatterns[below(std::size(kPatterns))], 4);
    }
}

void Mutator::changeByte(std::string& input) {
    if (input.empty()) return void(input.push_back(char(below(256))));
    char& byte = input[below(input.size())];
    byte = below(2) ? char(byte ^ (1 << below(8))) : char(below(256));
}

void Mutator::changeNumber(std::string& input) {
    const auto isDigit = [&](std::size_t at) {
        return at < input.size() && std::isdigit(static_cast<unsigned char>(input[at]));
    };
    std::size_t from = below(input.size());
    while (from < input.size() && !isDigit(from)) ++from;
    std::size_t to = from;
    while (isDigit(to)) ++to;
    if (from < to) input.replace(from, to - from, kNumbers[below(std::size(kNumbers))]);
}

void Mutator::putIn(std::string& input, const std::string& what) {
    input.insert(below(input.size() + 1), what);
}

std::string Mutator::piece(const std::string& of) {
    return of.substr(below(of.size()), 1 + below(1 + below(256)));
}

} // namespace fuzz
