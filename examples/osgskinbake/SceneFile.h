// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

#include <string>

namespace bake {

/// Whether OpenSceneGraph's own formats have the extension of a file: .osgb, .osgt, .osgx.
bool isSceneFile(const std::string& file);

/// Writes a scene to one of them, textures included: the file needs no other one.
/// \throw osgSkin::Error if it cannot be written
void writeScene(const std::string& file, const osg::Node& scene);

} // namespace bake
