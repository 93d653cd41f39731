// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKSCENE_H
#define OSGSKINIMPORT_CHECKSCENE_H 1

#include <osg/Node>

#include <string>

namespace osgSkin {

/// Checks a scene read by OpenSceneGraph, before it is drawn or updated: vertices and matrices are
/// finite and within +-1e18, primitives index existing vertices, arrays have one element per
/// vertex, rigs and morphs match their geometries, and animations have ordered keys of the right
/// type. Reports channels without a target. Sets animations of a single pose to repeat, because
/// osgAnimation divides by their length otherwise.
/// \param scene whose animations may be changed
/// \param path of the file, for errors
/// \throw osgSkin::Error with the file, the object and the reason
void checkScene(osg::Node& scene, const std::string& path);

} // namespace osgSkin

#endif
