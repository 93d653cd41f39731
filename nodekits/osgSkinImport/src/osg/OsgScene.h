// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OSG_OSGSCENE_H
#define OSGSKINIMPORT_OSG_OSGSCENE_H

#include "mesh/CornerMesh.h"

#include <osgSkinRig/RestSkeleton>

#include <osg/Node>
#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads the geometries of a file that osgDB reads.
/// \throw osgSkin::Error as readObjMesh()
CornerMesh readOsgMesh(const std::string& path, const osgDB::Options* options);

/// The bind pose of the scene's first osgAnimation::Skeleton that has a bone, in the scene's space.
/// \throw osgSkin::Error with `path` where there is none, or its bones make no sense
RestSkeleton readOsgSkeleton(osg::Node& scene, const std::string& path);

} // namespace osgSkin

#endif
