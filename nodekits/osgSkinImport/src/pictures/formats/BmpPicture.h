// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BMPPICTURE_H
#define OSGSKINIMPORT_BMPPICTURE_H 1

#include "pictures/formats/PictureBytes.h"
#include "pictures/formats/PictureSize.h"

namespace osgSkin {

/// The size that a BMP picture tells.
///
/// \throw osgSkin::Error where the file lacks what OpenSceneGraph's reader takes for granted
PictureSize bmpSize(const PictureBytes& bytes);

} // namespace osgSkin

#endif
