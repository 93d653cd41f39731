// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PICTUREBYTES_H
#define OSGSKINIMPORT_PICTUREBYTES_H 1

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace osgSkin {

/// A picture's file as its checks look at it.
class PictureBytes {
public:
    /// \param name of the picture, for errors
    /// \param bytes must outlive this
    PictureBytes(std::string name, std::string_view bytes)
        : _name(std::move(name)), _bytes(bytes) {}

    std::uint64_t size() const { return _bytes.size(); }
    std::string_view all() const { return _bytes; }
    bool startsWith(std::string_view mark) const { return _bytes.substr(0, mark.size()) == mark; }

    /// One to four bytes as a number, the least or the most significant one first. Fails where the
    /// file ends before.
    std::uint32_t little(std::uint64_t at, unsigned count) const;
    std::uint32_t big(std::uint64_t at, unsigned count) const;
    std::uint32_t byte(std::uint64_t at) const { return little(at, 1); }

    /// Throws osgSkin::Error "NAME: REASON".
    [[noreturn]] void fail(const std::string& reason) const;
    void require(bool holds, const char* otherwise) const {
        if (!holds) fail(otherwise);
    }
    /// Fails where the file has fewer bytes.
    void requireSize(std::uint64_t bytes) const;

private:
    std::string _name;
    std::string_view _bytes;
};

} // namespace osgSkin

#endif
