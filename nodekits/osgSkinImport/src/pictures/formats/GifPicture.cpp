// SPDX-License-Identifier: MIT
#include "pictures/formats/GifPicture.h"

namespace osgSkin {
namespace {

constexpr std::uint32_t kGifExtension = 0x21, kGifImage = 0x2c, kGifEnd = 0x3b,
                        kGraphicControl = 0xf9;

std::uint64_t coloursOf(std::uint32_t flags) {
    return (flags & 0x80) != 0 ? 3u << ((flags & 7) + 1) : 0;
}

/// Behind blocks that each tell their length, the last one none.
std::uint64_t behindBlocks(const PictureBytes& bytes, std::uint64_t at) {
    while (const std::uint32_t length = bytes.byte(at)) at += 1 + length;
    return at + 1;
}

} // namespace

PictureSize gifSize(const PictureBytes& bytes) {
    bytes.require(bytes.startsWith("GIF8"), "no GIF picture");
    PictureSize size;
    size.width = bytes.little(6, 2);
    size.height = bytes.little(8, 2);
    std::uint64_t frames = 0;
    for (std::uint64_t at = 13 + coloursOf(bytes.byte(10)); bytes.byte(at) != kGifEnd;) {
        const std::uint32_t block = bytes.byte(at++);
        if (block == kGifExtension) {
            bytes.require(bytes.byte(at) != kGraphicControl || bytes.byte(at + 1) >= 4,
                          "a GIF picture with a graphic control of less than 4 bytes");
            at = behindBlocks(bytes, at + 1);
        } else {
            bytes.require(block == kGifImage, "a GIF picture with a block of an unknown kind");
            at = behindBlocks(bytes, at + 10 + coloursOf(bytes.byte(at + 8)));
            ++frames;
        }
    }
    size.images = frames > 1 ? frames + 2 : 1; // each frame is kept as a whole picture
    return size;
}

} // namespace osgSkin
