// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_TRACKOFFSETS_H
#define OSGSKINIMPORT_TRACKOFFSETS_H 1

#include <assimp/scene.h>

namespace osgSkin {

/// Gives nodes at their parents' origin the one position that their track holds. Some exporters
/// write the bones' lengths there only.
///
/// \param animation whose tracks are looked at
/// \param root of the nodes; they may be changed
void takeTrackOffsets(const aiAnimation& animation, aiNode& root);

} // namespace osgSkin

#endif
