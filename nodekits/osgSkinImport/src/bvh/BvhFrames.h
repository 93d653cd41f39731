// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BVHFRAMES_H
#define OSGSKINIMPORT_BVHFRAMES_H 1

#include "bvh/BvhFile.h"
#include "bvh/BvhTokens.h"

#include <string>

namespace osgSkin {

/// Reads the MOTION, up to the end of the file, into `file`, whose joints are known: frame time,
/// number of frames and their values. Memory is taken for what the file holds, not for what it
/// declares.
/// \throw osgSkin::Error with the line
void readBvhFrames(BvhTokens& words, const std::string& path, BvhFile& file);

} // namespace osgSkin

#endif
