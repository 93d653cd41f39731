// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKSCENE_H
#define OSGSKINIMPORT_CHECKSCENE_H 1

#include <osg/Node>

#include <string>

namespace osgSkin {

/// Checks a scene that OpenSceneGraph has read, before anything draws or updates it: vertices and
/// matrices are finite and within +-1e18, primitives name vertices that exist, arrays are as long
/// as these, rigs and morphs fit their geometries, and animations have keys in order that fit what
/// they move. Reports channels that move nothing. Animations of one pose are set to repeat, since
/// osgAnimation divides by their length otherwise.
/// \param path of the file, for errors
/// \throw osgSkin::Error with the file, the object and the reason
void checkScene(osg::Node& scene, const std::string& path);

} // namespace osgSkin

#endif
