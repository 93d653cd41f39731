// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PICTURECHECK_H
#define OSGSKINIMPORT_PICTURECHECK_H 1

#include <osgSkinImport/ReadLimits>

#include <cstddef>
#include <string>
#include <string_view>

namespace osgSkin {

/// Looks at the pictures of one model before OpenSceneGraph's readers do.
///
/// They are refused, by osgSkin::Error, where a reader would read or write beyond what there is,
/// not come to an end, or take more memory for all of them than their files are worth
/// (ReadLimits::pixelsOf()); and in formats that nothing looks at, unless ReadLimits::pictures
/// names them.
class PictureCheck {
public:
    explicit PictureCheck(ReadLimits limits) : _limits(std::move(limits)) {}

    /// \param name of the picture, for errors
    /// \param extension of the format, as the reader is found by
    /// \param bytes of the whole file
    void take(const std::string& name, const std::string& extension, std::string_view bytes);

    /// The same of a file.
    void takeFile(const std::string& path);

private:
    const ReadLimits _limits;
    double _pixels = 0.0;   ///< of four bytes, of those that were taken
    std::size_t _bytes = 0; ///< of their files
};

} // namespace osgSkin

#endif
