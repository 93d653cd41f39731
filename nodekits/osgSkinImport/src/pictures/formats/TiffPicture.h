// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_TIFFPICTURE_H
#define OSGSKINIMPORT_TIFFPICTURE_H 1

#include "pictures/formats/PictureBytes.h"
#include "pictures/formats/PictureSize.h"

namespace osgSkin {

/// The size that a TIFF picture tells.
///
/// \throw osgSkin::Error where the file lacks what OpenSceneGraph's reader takes for granted
PictureSize tiffSize(const PictureBytes& bytes);

} // namespace osgSkin

#endif
