// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BYTES_H
#define OSGSKINBIND_BYTES_H

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace osgSkin {

/// Values as they lie in this machine's memory, one after the other.
class ByteWriter {
public:
    template <typename T>
    void add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        _bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }

    /// The number of them first. T has no padding.
    template <typename T>
    void addAll(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(static_cast<std::uint64_t>(values.size()));
        _bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
    }

    void addText(const std::string& text) {
        add(static_cast<std::uint64_t>(text.size()));
        _bytes += text;
    }

    const std::string& bytes() const { return _bytes; }

private:
    std::string _bytes;
};

/// Takes back what a ByteWriter wrote, in the same order. What does not fit leaves it failed, and
/// everything after that zero and empty.
class ByteReader {
public:
    explicit ByteReader(const std::string& bytes) : _bytes(bytes) {}

    template <typename T>
    void take(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (has(1, sizeof(T))) copy(&value, sizeof(T));
    }

    template <typename T>
    void takeAll(std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::uint64_t count = 0;
        take(count);
        if (!has(count, sizeof(T))) return;
        values.resize(static_cast<std::size_t>(count));
        copy(values.data(), sizeof(T) * values.size());
    }

    void takeText(std::string& text) {
        std::vector<char> letters;
        takeAll(letters);
        text.assign(letters.begin(), letters.end());
    }

    /// All was there, and nothing more.
    bool isComplete() const { return !_failed && _at == _bytes.size(); }
    bool failed() const { return _failed; }

private:
    bool has(std::uint64_t count, std::size_t size) {
        if (_failed || count > (_bytes.size() - _at) / size) _failed = true;
        return !_failed;
    }

    void copy(void* to, std::size_t size) {
        if (size > 0) std::memcpy(to, _bytes.data() + _at, size);
        _at += size;
    }

    const std::string& _bytes;
    std::size_t _at = 0;
    bool _failed = false;
};

} // namespace osgSkin

#endif
