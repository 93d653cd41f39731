// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BVHHIERARCHY_H
#define OSGSKINIMPORT_BVHHIERARCHY_H 1

#include "bvh/BvhFile.h"
#include "bvh/BvhTokens.h"

namespace osgSkin {

/// Reads the HIERARCHY, up to the brace that closes the ROOT, into `file`: joints and channels.
/// \throw osgSkin::Error with the line
void readBvhHierarchy(BvhTokens& words, const ReadLimits& limits, BvhFile& file);

} // namespace osgSkin

#endif
