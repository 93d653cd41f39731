// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OSG_OSGSCENE_H
#define OSGSKINIMPORT_OSG_OSGSCENE_H

#include "mesh/CornerMesh.h"

#include <osgSkinRig/RestSkeleton>

#include <osg/Node>
#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads the geometries of a file by osgDB.
/// \throw osgSkin::Error like readObjMesh()
CornerMesh readOsgMesh(const std::string& path, const osgDB::Options* options);

/// The bind pose of the scene's first osgAnimation::Skeleton with a bone, in the scene's space.
/// \param scene to search
/// \param path of the file, for errors
/// \throw osgSkin::Error with `path` if there is none, or its bones are invalid
RestSkeleton readOsgSkeleton(osg::Node& scene, const std::string& path);

} // namespace osgSkin

#endif
