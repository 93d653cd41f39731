// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Program>
#include <osg/Shader>

#include <string>

namespace osgSkin {

/// Texture units of a crowd's shaders, beyond those that materials use.
enum CrowdUnit { kCrowdModelUnit = 10, kCrowdClipUnit, kCrowdInstanceUnit, kCrowdVisibleUnit };

/// Buffer indices of cullProgram().
enum CullBuffer { kCommandBuffer, kVisibleBuffer };

constexpr unsigned int kMostLevels = 8;

/// The functions that crowdVertexShader() documents, in GLSL 3.30.
std::string crowdText();

/// Lit from light 0, with the material's diffuse colour and the texture of unit 0: what a crowd is
/// drawn with that has no program of its own.
osg::Program* plainCrowdProgram();

/// Finds which instances a camera sees, and in which level of detail; one a thread. GLSL 4.30.
osg::Program* cullProgram();

/// Threads of one group of it.
constexpr unsigned int kCullThreads = 64;

} // namespace osgSkin
