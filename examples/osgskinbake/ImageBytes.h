// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osg/Image>

#include <optional>
#include <string>

namespace bake {

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
