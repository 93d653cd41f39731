// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_DDSPICTURE_H
#define OSGSKINIMPORT_DDSPICTURE_H 1

#include "pictures/formats/PictureBytes.h"
#include "pictures/formats/PictureSize.h"

namespace osgSkin {

/// The size that a DDS picture tells.
///
/// \throw osgSkin::Error where the file lacks what OpenSceneGraph's reader takes for granted
PictureSize ddsSize(const PictureBytes& bytes);

} // namespace osgSkin

#endif
