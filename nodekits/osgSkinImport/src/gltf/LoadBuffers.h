// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_LOADBUFFERS_H
#define OSGSKINIMPORT_LOADBUFFERS_H 1

#include "gltf/GltfFile.h"

namespace osgSkin {

/// Gives a file's buffers what they hold: the binary chunk, which is the first one's where that
/// names nothing else, data in the file's text, and other files, each read once.
/// \throw osgSkin::Error with the file and the place where one cannot be had, or all are larger
///        than a file may be
void loadBuffers(GltfFile& file);

} // namespace osgSkin

#endif
