// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Error>

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace osgSkin {

/// Takes words one by one; never past the end, and never more memory than the words that are there.
class WordReader {
public:
    explicit WordReader(const std::vector<std::uint32_t>& words) : _words(words) {}

    std::uint32_t word() {
        if (_next == _words.size()) fail("it ends too early");
        return _words[_next++];
    }
    /// A count of things that take at least `size` words each.
    std::uint32_t count(const char* what, std::size_t size) {
        const std::uint32_t number = word();
        if (number > (_words.size() - _next) / size)
            fail(std::to_string(number) + " " + what + " have no room in it");
        return number;
    }
    float real() {
        const std::uint32_t bits = word();
        float value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    double longReal() {
        const std::uint64_t low = word();
        const std::uint64_t bits = low | (std::uint64_t{word()} << 32);
        double value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    glm::dvec3 longVector() {
        const double x = longReal();
        const double y = longReal();
        return {x, y, longReal()};
    }
    std::string text() {
        const std::uint32_t size = word();
        if (size > 4 * (_words.size() - _next)) fail("a name has no room in it");
        std::string result;
        std::uint32_t bytes = 0;
        for (std::uint32_t i = 0; i < size; ++i, bytes >>= 8) {
            if (i % 4 == 0) bytes = word();
            result.push_back(static_cast<char>(bytes & 0xffu));
        }
        return result;
    }
    [[noreturn]] static void fail(const std::string& what) {
        throw Error("skin model block: " + what);
    }
    bool atEnd() const { return _next == _words.size(); }

private:
    const std::vector<std::uint32_t>& _words;
    std::size_t _next = 0;
};

} // namespace osgSkin
