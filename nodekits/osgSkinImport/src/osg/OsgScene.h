// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OSGSCENE_H
#define OSGSKINIMPORT_OSGSCENE_H 1

#include <osgSkinRig/RestSkeleton>

#include <osg/Node>
#include <osg/ref_ptr>
#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads a scene by osgDB.
/// \throw osgSkin::Error with the file and the reason
osg::ref_ptr<osg::Node> readOsgScene(const std::string& path, const osgDB::Options* options);

/// The bind pose of the scene's first osgAnimation::Skeleton that has a bone, in the scene's space.
/// \throw osgSkin::Error with `path` where there is none, or its bones make no sense
RestSkeleton readOsgSkeleton(osg::Node& scene, const std::string& path);

} // namespace osgSkin

#endif
