// SPDX-License-Identifier: MIT
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

/// Writes a file atomically: to a temporary file in the same folder, which finish() renames. Writes
/// directly to targets that are not regular files, such as pipes.
class WholeFile {
public:
    /// \throw osgSkin::Error if the file cannot be written
    explicit WholeFile(const std::string& file);
    /// Removes the temporary file if finish() was not called.
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    std::FILE* stream() { return _stream; }

    /// \throw osgSkin::Error if the file cannot be written
    void write(const std::string& data);

    /// Renames the temporary file to its final name.
    /// \throw osgSkin::Error if some data could not be written
    void finish();

private:
    [[noreturn]] void fail() const;

    std::string _file;    ///< path given by the caller
    std::string _target;  ///< the same with links resolved
    std::string _written; ///< path of the temporary file; empty if written directly
    std::FILE* _stream = nullptr;
};

/// Sets the files that are never overwritten under any name: those a character was read from.
void keepFiles(const std::vector<std::string>& files);

/// Removes the temporary file if a signal ends the program.
void removeUnfinishedOnSignals();

/// Numbers in little-endian order on any machine.
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

/// \throw osgSkin::Error if the file cannot be written
void writeBytes(const std::string& file, const std::string& data);

/// An image as the bytes of a PNG or JPEG file.
struct ImageBytes {
    std::string data;
    bool isJpeg = false;
    std::string file; ///< source of the bytes; empty if encoded from the image
};

/// The bytes of the image's own file if that is PNG or JPEG, otherwise the image encoded as PNG.
/// Returns nothing, and logs a notice, if it cannot be encoded.
///
/// \param image the image
/// \param folder base of the image's relative file name
std::optional<ImageBytes> bytesOf(const osg::Image& image, const std::string& folder);

} // namespace bake

#endif
