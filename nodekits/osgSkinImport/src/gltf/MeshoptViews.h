// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESHOPTVIEWS_H
#define OSGSKINIMPORT_MESHOPTVIEWS_H 1

#include "gltf/GltfFile.h"

namespace osgSkin {

/// Unpacks buffer views that are compressed by meshopt (EXT_meshopt_compression, and what of
/// KHR_meshopt_compression the library at hand reads), so that no extension is left at them. Views
/// whose bytes the file holds unpacked, too, lose the extension alone.
///
/// \param file after loadBuffers(), not checked yet; its buffers, views and size are changed
/// \throw osgSkin::Error with the file and the view where what is compressed is malformed or would
///        be larger than the limits; and by the compression's name in a build without
///        meshoptimizer
void unpackMeshopt(GltfFile& file);

} // namespace osgSkin

#endif
