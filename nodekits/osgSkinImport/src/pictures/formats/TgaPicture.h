// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_TGAPICTURE_H
#define OSGSKINIMPORT_TGAPICTURE_H 1

#include "pictures/formats/PictureBytes.h"
#include "pictures/formats/PictureSize.h"

namespace osgSkin {

/// The size that a TGA picture tells.
///
/// \throw osgSkin::Error where the file lacks what OpenSceneGraph's reader takes for granted
PictureSize tgaSize(const PictureBytes& bytes);

} // namespace osgSkin

#endif
