// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKPICTURE_H
#define OSGSKINIMPORT_CHECKPICTURE_H 1

#include <osgSkinImport/ReadLimits>

#include <string>
#include <string_view>

namespace osgSkin {

/// Throws osgSkin::Error where OpenSceneGraph's reader of a picture would read or write beyond what
/// there is, not come to an end, or take more memory than the picture's size is worth
/// (ReadLimits::pixelsOf()); and of formats that nothing looks at, unless ReadLimits::pictures
/// names them.
///
/// \param name of the picture, for errors
/// \param extension of the format, as the reader is found by
/// \param bytes of the whole file
void checkPicture(const std::string& name, const std::string& extension, std::string_view bytes,
                  const ReadLimits& limits);

/// The same of a file.
void checkPictureFile(const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
