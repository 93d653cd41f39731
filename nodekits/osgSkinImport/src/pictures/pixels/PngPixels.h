// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PNGPIXELS_H
#define OSGSKINIMPORT_PNGPIXELS_H 1

#include "pictures/formats/PictureBytes.h"

namespace osgSkin {

/// Unpacks the pixels of a PNG picture row by row, as OpenSceneGraph's reader does, and drops them:
/// that reader loses the memory of a picture that libpng refuses half way.
///
/// \param bytes of a picture whose size pngSize() has looked at
/// \throw osgSkin::Error where libpng refuses it
void unpackPng(const PictureBytes& bytes);

} // namespace osgSkin

#endif
