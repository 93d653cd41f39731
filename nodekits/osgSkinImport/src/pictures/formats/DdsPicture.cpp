// SPDX-License-Identifier: MIT
#include "pictures/formats/DdsPicture.h"

namespace osgSkin {
namespace {

constexpr std::uint32_t kDdsHasDepth = 0x800000;
constexpr std::uint64_t kDdsHeader = 128, kDdsSecondHeader = 20;

/// Beyond this readers count bytes past 32 bits, at the most that a pixel has.
constexpr std::uint64_t kMostDdsPixels = 1u << 26;

} // namespace

PictureSize ddsSize(const PictureBytes& bytes) {
    bytes.require(bytes.startsWith("DDS ") && bytes.little(4, 4) == 124 &&
                      bytes.little(76, 4) == 32,
                  "no DDS picture");
    const bool hasSecond = bytes.size() >= 88 && bytes.all().substr(84, 4) == "DX10";
    bytes.requireSize(kDdsHeader + (hasSecond ? kDdsSecondHeader : 0));
    PictureSize size;
    size.height = bytes.little(12, 4);
    size.width = bytes.little(16, 4);
    const std::uint64_t depth = bytes.little(24, 4);
    if ((bytes.little(8, 4) & kDdsHasDepth) != 0 && depth > 0) size.images = depth;
    bytes.require(size.width <= kLongestSide && size.height <= kLongestSide &&
                      size.images <= kLongestSide,
                  "a DDS picture that is too long");
    const std::uint64_t pixels = size.width * size.height * size.images;
    bytes.require(pixels < kMostDdsPixels, "a DDS picture that is too large");
    bytes.requireSize(pixels / 2); // the formats that pack most have half a byte
    return size;
}

} // namespace osgSkin
