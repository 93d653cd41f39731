// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_WEBPICTURE_H
#define OSGSKINIMPORT_WEBPICTURE_H 1

#include "pictures/formats/PictureBytes.h"
#include "pictures/formats/PictureSize.h"

namespace osgSkin {

/// The size that a PNG or a JPEG picture tells.
///
/// \throw osgSkin::Error where the file lacks what OpenSceneGraph's reader takes for granted
PictureSize pngSize(const PictureBytes& bytes);
PictureSize jpegSize(const PictureBytes& bytes);

} // namespace osgSkin

#endif
