// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMP_COLLADACURVES_H
#define OSGSKINIMPORT_ASSIMP_COLLADACURVES_H

#include "assimp/XmlText.h"

#include <osgSkinImport/ReadLimits>

namespace osgSkin {

/// Samples a Collada file's curves 30 times a second where its keys are far apart and Assimp's
/// straight lines and shortest rotations between them are not what the file says: curves with
/// BEZIER, HERMITE or STEP interpolation, and angles. Reports curves that stay as they are.
/// \param path of the file, for errors
/// \return what to replace
/// \throw osgSkin::Error if there would be more samples than the file has room for
TextEdits sampleCurves(const std::string& path, std::string_view xml, const ReadLimits& limits);

} // namespace osgSkin

#endif
