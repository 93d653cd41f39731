// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESHSCENE_H
#define OSGSKINIMPORT_MESHSCENE_H 1

#include <osg/Node>
#include <osg/ref_ptr>
#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Whether a file, by its extension, has a reader of ours: OSG's own of these formats believe what
/// they read, and are never asked.
bool isOurFormat(const std::string& path);

/// Reads a mesh of such a file as OSG's readers would: OBJ, whose Y axis is taken for up unless
/// `noRotation` is among the options, and PLY.
///
/// \param path of a file that is there
/// \param options where to look for textures, with limits (ReadLimits::of())
/// \return never null
/// \throw osgSkin::Error with the file and the reason; also for formats that hold no mesh alone
osg::ref_ptr<osg::Node> readMeshScene(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
