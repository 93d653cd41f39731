// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Program>

namespace osgSkin {

/// The texture units and buffer indices of the compute shaders.
enum ComputeUnit { kModelUnit, kPaletteUnit, kTangentUnit };
enum ComputeBuffer { kPositionBuffer, kNormalBuffer, kTangentBuffer };

/// Deforms the vertices of one skin, one a thread; shared by all. 64 threads a group.
///
/// \param withTangents reads osgSkinTangents and writes tangents, too
osg::Program* computeProgram(bool withTangents);

constexpr unsigned int kComputeThreads = 64;

} // namespace osgSkin
