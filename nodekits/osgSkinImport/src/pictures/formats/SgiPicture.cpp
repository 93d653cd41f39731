// SPDX-License-Identifier: MIT
#include "pictures/formats/SgiPicture.h"

namespace osgSkin {
namespace {

/// A packed row: runs of one value or of several, each told by a number; a run of none is its end,
/// which the reader goes on to wherever it is, and writes what comes before.
void requireSgiRow(const PictureBytes& bytes, std::uint64_t at, std::uint64_t end,
                   std::uint64_t width, unsigned channelBytes) {
    std::uint64_t count = 0;
    while (at < end) {
        const std::uint32_t code = bytes.big(at, channelBytes), run = code & 127;
        if (run == 0) return;
        count += run;
        bytes.require(count <= width, "an SGI picture with a row of more pixels than it is wide");
        at += std::uint64_t{channelBytes} * (1 + ((code & 128) != 0 ? run : 1));
    }
    bytes.fail("an SGI picture with a row that has no end");
}

} // namespace

PictureSize sgiSize(const PictureBytes& bytes) {
    bytes.require(bytes.startsWith("\x01\xda"), "no SGI picture");
    const std::uint32_t packed = bytes.byte(2), channelBytes = bytes.byte(3);
    const std::uint64_t channels = bytes.big(10, 2);
    PictureSize size;
    size.width = bytes.big(6, 2);
    size.height = bytes.big(8, 2);
    bytes.require(packed <= 1 && (channelBytes == 1 || channelBytes == 2) && channels >= 1 &&
                      channels <= 4,
                  "an SGI picture of an unknown kind");
    size.bytesPerPixel = channelBytes * channels;
    return size;
}

void requireSgiRows(const PictureBytes& bytes) {
    constexpr std::uint64_t kSgiHeader = 512;
    const std::uint32_t channelBytes = bytes.byte(3);
    const std::uint64_t width = bytes.big(6, 2),
                        rows = std::uint64_t{bytes.big(8, 2)} * bytes.big(10, 2),
                        rowBytes = width * channelBytes;
    if (bytes.byte(2) == 0) return bytes.requireSize(kSgiHeader + rows * rowBytes);
    // Where each row stands, behind all of these how long each is.
    for (std::uint64_t row = 0; row < rows; ++row) {
        const std::uint64_t at = kSgiHeader + 4 * row;
        const std::uint64_t begin = bytes.big(at, 4), length = bytes.big(at + 4 * rows, 4);
        bytes.requireSize(begin + length);
        requireSgiRow(bytes, begin, begin + length, width, channelBytes);
        bytes.require(length <= 256 * rowBytes,
                      "an SGI picture with a row longer than rows can be");
    }
}

} // namespace osgSkin
