// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GIFPIXELS_H
#define OSGSKINIMPORT_GIFPIXELS_H 1

#include "pictures/formats/PictureBytes.h"

namespace osgSkin {

/// Unpacks the pixels of a GIF picture line by line, as OpenSceneGraph's reader does, and drops
/// them: that reader loses the memory of a picture that giflib refuses half way, and refuses every
/// GIF picture from then on.
///
/// \param bytes of a picture whose size gifSize() has looked at
/// \throw osgSkin::Error where giflib refuses it, or a frame is not within the picture
void unpackGif(const PictureBytes& bytes);

} // namespace osgSkin

#endif
