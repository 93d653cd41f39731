// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OSGSCENE_H
#define OSGSKINIMPORT_OSGSCENE_H 1

#include <osgSkinRig/RestSkeleton>

#include <osg/Node>

#include <string>

namespace osgSkin {

/// The bind pose of the scene's first osgAnimation::Skeleton that has a bone, in the scene's space.
/// \throw osgSkin::Error with `path` where there is none, or its bones make no sense
RestSkeleton readOsgSkeleton(osg::Node& scene, const std::string& path);

} // namespace osgSkin

#endif
