// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBAKE_BYTES_H
#define OSGSKINBAKE_BYTES_H

#include <glm/vec3.hpp>
#include <osg/Image>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace bake {

/// A file that is there whole or not at all: written beside its name, and renamed once finished.
/// What is no regular file, as a pipe, is written directly.
class WholeFile {
public:
    /// \throw osgSkin::Error where it cannot be written
    explicit WholeFile(const std::string& file);
    /// Removes what has not been finished.
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    std::FILE* stream() { return _stream; }

    /// \throw osgSkin::Error where it cannot be written
    void write(const std::string& data);

    /// Gives the file its name.
    /// \throw osgSkin::Error where not all has been written
    void finish();

private:
    [[noreturn]] void fail() const;

    std::string _file;    ///< as it was asked for
    std::string _target;  ///< where links lead to
    std::string _written; ///< where it is until it is finished; empty: there already
    std::FILE* _stream = nullptr;
};

/// Files that are never written over, however they are called: those that a character was read
/// from.
void keepFiles(const std::vector<std::string>& files);

/// Lets a signal that ends the program remove what has not been finished.
void removeUnfinishedOnSignals();

/// Numbers in little-endian order, whatever the machine's is.
class Bytes {
public:
    void add(std::uint8_t value) { data += static_cast<char>(value); }
    void add(std::uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8) data += static_cast<char>(value >> shift & 255);
    }
    void add(std::int32_t value) { add(static_cast<std::uint32_t>(value)); }
    void add(float value) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        add(bits);
    }
    void add(const glm::dvec3& v) {
        add(static_cast<float>(v.x));
        add(static_cast<float>(v.y));
        add(static_cast<float>(v.z));
    }

    std::string data;
};

/// \throw osgSkin::Error where the file cannot be written
void writeBytes(const std::string& file, const std::string& data);

/// An image as the bytes of a PNG or JPEG file.
struct ImageBytes {
    std::string data;
    bool isJpeg = false;
    std::string file; ///< that they were read from; empty where they were made
};

/// The file that the image was read from where that is PNG or JPEG, else a PNG file made of it.
/// Nothing, with a notice, where it cannot be made.
///
/// \param folder where its file name is relative to
std::optional<ImageBytes> bytesOf(const osg::Image& image, const std::string& folder);

} // namespace bake

#endif
