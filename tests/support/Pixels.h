// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>

#include <algorithm>
#include <cstdlib>

namespace test {

/// Red, green or blue of a picture with three bytes per pixel.
inline int channel(const osg::Image& image, unsigned int pixel, unsigned int i) {
    return image.data()[pixel * 3 + i];
}

inline unsigned int pixelCount(const osg::Image& image) {
    return static_cast<unsigned int>(image.s() * image.t());
}

/// Number of pixels in which two pictures of one size clearly differ.
inline unsigned int unlikePixels(const osg::Image& a, const osg::Image& b) {
    unsigned int unlike = 0;
    for (unsigned int pixel = 0; pixel < pixelCount(a); ++pixel) {
        int most = 0;
        for (unsigned int i = 0; i < 3; ++i)
            most = std::max(most, std::abs(channel(a, pixel, i) - channel(b, pixel, i)));
        unlike += most > 24 ? 1 : 0;
    }
    return unlike;
}

/// Number of pixels that are not the black background.
inline unsigned int seenPixels(const osg::Image& image) {
    unsigned int seen = 0;
    for (unsigned int pixel = 0; pixel < pixelCount(image); ++pixel)
        seen += channel(image, pixel, 0) + channel(image, pixel, 1) + channel(image, pixel, 2) > 24;
    return seen;
}

} // namespace test
