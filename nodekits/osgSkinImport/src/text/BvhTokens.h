// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace osgSkin {

/// Splits the text of a BVH file into words as Assimp does, and knows the line of each.
class BvhTokens {
public:
    BvhTokens(const std::string& path, std::string_view text) : _path(path), _rest(text) {}

    /// The next word; empty at the end of the file.
    std::string_view next();

    /// Reads the next word and throws unless it is `word`.
    void expect(std::string_view word);

    /// Reads a finite number; `what` names it in the error.
    double number(const std::string& what);

    /// Reads a whole number from 0 to `largest`.
    std::size_t count(const std::string& what, std::size_t largest);

    /// Throws "PATH: line N: MESSAGE" for the word read last.
    [[noreturn]] void fail(const std::string& message) const;

    /// Line of the word read last, counted from 1.
    std::size_t line() const { return _line; }

private:
    const std::string& _path;
    std::string_view _rest;
    std::size_t _line = 1;
};

/// The word in quotes, or "the end of the file" where it is empty.
std::string described(std::string_view word);

} // namespace osgSkin
