// SPDX-License-Identifier: MIT
#include "pictures/formats/BmpPicture.h"

#include <algorithm>
#include <cstdlib>

namespace osgSkin {
namespace {

constexpr std::uint32_t kBmpPlain = 0, kBmpMasks = 3;

/// What OpenSceneGraph reads beyond its end where a picture has few colours and names others.
void requireColours(const PictureBytes& bytes, const PictureSize& size, std::uint32_t bits,
                    std::uint64_t colours, std::uint64_t pixels, std::uint64_t rowBytes) {
    for (std::uint64_t y = 0; y < size.height; ++y)
        for (std::uint64_t x = 0; x < size.width; ++x) {
            const std::uint64_t bit = x * bits;
            const std::uint32_t eight = bytes.byte(pixels + y * rowBytes + bit / 8);
            const std::uint32_t colour = eight >> (8 - bits - bit % 8) & ((1u << bits) - 1);
            bytes.require(colour < colours, "a BMP picture with more colours than its table");
        }
}

} // namespace

PictureSize bmpSize(const PictureBytes& bytes) {
    bytes.require(bytes.startsWith("BM"), "no BMP picture");
    const std::uint32_t header = bytes.little(14, 4);
    bytes.require(header == 40 || header == 108 || header == 124,
                  "a BMP picture with a header of an unknown length");
    const auto width = static_cast<std::int32_t>(bytes.little(18, 4));
    const auto height = static_cast<std::int32_t>(bytes.little(22, 4));
    PictureSize size;
    size.width = static_cast<std::uint64_t>(std::max<std::int64_t>(width, 0));
    size.height = static_cast<std::uint64_t>(std::abs(std::int64_t(height)));
    const std::uint32_t bits = bytes.little(28, 2), packing = bytes.little(30, 4);
    bytes.require(bits == 1 || bits == 4 || bits == 8 || bits == 16 || bits == 24 || bits == 32,
                  "a BMP picture with pixels of an unknown length");
    bytes.require(packing == kBmpPlain || packing == kBmpMasks, "a BMP picture that is packed");
    bytes.require(size.width <= kLongestSide && size.height <= kLongestSide,
                  "a BMP picture that is too long");
    const std::uint64_t rowBytes = (size.width * bits + 31) / 32 * 4, pixels = bytes.little(10, 4);
    bytes.requireSize(pixels + rowBytes * size.height);
    if (bits == 16 && packing == kBmpMasks)
        for (const std::uint64_t at : {54u, 58u, 62u})
            bytes.require(bytes.little(at, 2) != 0, "a BMP picture whose pixels lack a colour");
    if (bits > 8) return size;
    const std::uint64_t most = std::uint64_t{1} << bits;
    const std::uint64_t told = bytes.little(46, 4), colours = told == 0 ? most : told;
    bytes.require(colours <= 256, "a BMP picture with a table of more than 256 colours");
    if (colours < most) requireColours(bytes, size, bits, colours, pixels, rowBytes);
    return size;
}

} // namespace osgSkin
