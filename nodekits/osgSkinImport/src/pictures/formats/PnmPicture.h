// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_PNMPICTURE_H
#define OSGSKINIMPORT_PNMPICTURE_H 1

#include "pictures/formats/PictureBytes.h"
#include "pictures/formats/PictureSize.h"

namespace osgSkin {

/// The size that a PNM (PPM, PGM, PBM) picture tells.
///
/// \throw osgSkin::Error where the file lacks what OpenSceneGraph's reader takes for granted
PictureSize pnmSize(const PictureBytes& bytes);

} // namespace osgSkin

#endif
