// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PICTURESIZE_H
#define OSGSKINIMPORT_PICTURESIZE_H 1

#include <cstdint>

namespace osgSkin {

/// Pixels along a side: no picture that anybody draws has more.
constexpr std::uint64_t kLongestSide = 1 << 16;

/// What a reader makes of a picture, by what stands in its file.
struct PictureSize {
    std::uint64_t width = 0, height = 0;
    std::uint64_t images = 1; ///< levels in depth, frames; or how often pixels are gone through
    std::uint64_t bytesPerPixel = 4;
};

} // namespace osgSkin

#endif
