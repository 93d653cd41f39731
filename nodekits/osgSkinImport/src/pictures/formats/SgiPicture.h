// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SGIPICTURE_H
#define OSGSKINIMPORT_SGIPICTURE_H 1

#include "pictures/formats/PictureBytes.h"
#include "pictures/formats/PictureSize.h"

namespace osgSkin {

/// The size that a SGI (RGB) picture tells.
///
/// \throw osgSkin::Error where the file lacks what OpenSceneGraph's reader takes for granted
PictureSize sgiSize(const PictureBytes& bytes);

/// Looks at the rows of a picture whose size is allowed: all may stand in the same place, so that a
/// small file has any number of them.
void requireSgiRows(const PictureBytes& bytes);

} // namespace osgSkin

#endif
