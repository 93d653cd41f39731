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

/// Reads words, never past the end, and never allocates more than the words need.
class BlockReader {
public:
    /// \param name of the block, for errors
    BlockReader(const std::vector<std::uint32_t>& words, const char* name)
        : _words(words), _name(name) {}

    std::uint32_t word() {
        if (_next == _words.size()) fail("it ends too early");
        return _words[_next++];
    }
    /// A count of items of at least `size` words each.
    std::uint32_t count(const char* what, std::size_t size) {
        const std::uint32_t number = word();
        if (number > (_words.size() - _next) / size)
            fail(std::to_string(number) + " " + what + " have no room in it");
        return number;
    }
    /// Refuses a block that has no room for items of `size` words each.
    void expect(std::size_t items, std::size_t size) const {
        if (items > (_words.size() - _next) / size) fail("it ends too early");
    }
    /// Copies words as they are: floats, or numbers.
    template <typename T>
    void copy(T* to, std::size_t count) {
        static_assert(sizeof(T) == sizeof(std::uint32_t));
        if (count > _words.size() - _next) fail("it ends too early");
        if (count > 0) std::memcpy(to, _words.data() + _next, count * sizeof(T));
        _next += count;
    }
    /// Two per word, the lower half first; of an odd count the last alone.
    void shorts(std::int16_t* to, std::size_t count) {
        if ((count + 1) / 2 > _words.size() - _next) fail("it ends too early");
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t both = _words[_next + i / 2];
            to[i] = static_cast<std::int16_t>(
                static_cast<std::uint16_t>(i % 2 == 0 ? both & 0xffffu : both >> 16));
        }
        _next += (count + 1) / 2;
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
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(std::string(_name) + ": " + what);
    }
    /// Passes over words, which stay valid as long as the block's.
    const std::uint32_t* skip(std::size_t count) {
        expect(count, 1);
        _next += count;
        return _words.data() + _next - count;
    }
    bool atEnd() const { return _next == _words.size(); }

private:
    const std::vector<std::uint32_t>& _words;
    const char* _name;
    std::size_t _next = 0;
};

/// Writes numbers and text as 32-bit words, without loss.
class BlockWriter {
public:
    std::vector<std::uint32_t> words;

    void put(std::uint32_t word) { words.push_back(word); }
    void put(std::size_t count) { words.push_back(static_cast<std::uint32_t>(count)); }
    void put(float value) {
        std::uint32_t word;
        std::memcpy(&word, &value, sizeof word);
        words.push_back(word);
    }
    void put(double value) {
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        words.push_back(static_cast<std::uint32_t>(bits));
        words.push_back(static_cast<std::uint32_t>(bits >> 32));
    }
    /// Copies words as they are: floats, or numbers.
    template <typename T>
    void copy(const T* from, std::size_t count) {
        static_assert(sizeof(T) == sizeof(std::uint32_t));
        words.resize(words.size() + count);
        if (count > 0) std::memcpy(words.data() + words.size() - count, from, count * sizeof(T));
    }
    /// Two per word, the lower half first; of an odd count the last alone.
    void shorts(const std::int16_t* from, std::size_t count) {
        for (std::size_t i = 0; i < count; i += 2) {
            std::uint32_t word = static_cast<std::uint16_t>(from[i]);
            if (i + 1 < count) word |= std::uint32_t{static_cast<std::uint16_t>(from[i + 1])} << 16;
            words.push_back(word);
        }
    }
    template <typename Vector>
    void putVector(const Vector& v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }
    void put(const std::string& text) {
        put(text.size());
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (i % 4 == 0) words.push_back(0);
            words.back() |= std::uint32_t{static_cast<unsigned char>(text[i])} << (8 * (i % 4));
        }
    }
};

} // namespace osgSkin
