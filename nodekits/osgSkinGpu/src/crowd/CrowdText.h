// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Program>
#include <osg/Shader>
#include <osg/ref_ptr>

#include <string>

namespace osgSkin {

/// Texture units of a crowd's shaders, above those that materials use.
enum CrowdUnit { kCrowdModelUnit = 10, kCrowdClipUnit, kCrowdInstanceUnit, kCrowdVisibleUnit };

/// Buffer indices of cullProgram().
enum CullBuffer { kCommandBuffer, kVisibleBuffer, kFitBuffer };

/// The passes of cullProgram(). With a limit of triangles, the last two come first: they find by
/// how much the sizes of levels are raised.
enum CullStep { kListMembers, kCountSizes, kFitLevels };

constexpr unsigned int kMaxLevels = 8;

/// The functions that crowdVertexShader() documents, in GLSL 3.30.
std::string crowdText();

/// Draws a crowd that has no program: lit from light 0, with the material's diffuse colour and the
/// texture of unit 0.
osg::ref_ptr<osg::Program> plainCrowdProgram();

/// Finds the instances that a camera sees and their levels of detail, one per thread. GLSL 4.30.
osg::ref_ptr<osg::Program> cullProgram();

/// Threads of a work group of cullProgram().
constexpr unsigned int kCullThreads = 64;

} // namespace osgSkin
