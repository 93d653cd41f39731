// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinGpu/CrowdCharacter>

#include <osg/ref_ptr>

#include <string>

/// Reads a character and bakes its first clip for a crowd on the graphics card, with three levels
/// of detail below its own.
///
/// \param seconds set to the clip's length
/// \throw std::runtime_error where the file cannot be read, or has no skin
osg::ref_ptr<osgSkin::CrowdCharacter> readCardCharacter(const std::string& file, double& seconds);
