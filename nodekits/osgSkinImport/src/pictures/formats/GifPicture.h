// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_GIFPICTURE_H
#define OSGSKINIMPORT_GIFPICTURE_H 1

#include "pictures/formats/PictureBytes.h"
#include "pictures/formats/PictureSize.h"

namespace osgSkin {

/// The size that a GIF picture tells.
///
/// \throw osgSkin::Error where the file lacks what OpenSceneGraph's reader takes for granted
PictureSize gifSize(const PictureBytes& bytes);

} // namespace osgSkin

#endif
