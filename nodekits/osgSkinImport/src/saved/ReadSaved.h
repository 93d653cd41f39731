// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_READSAVED_H
#define OSGSKINIMPORT_READSAVED_H 1

#include <osg/Node>
#include <osg/ref_ptr>
#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Whether a file's name says that OSG saved a scene in it: `.osgt`, `.osgb`, `.osgx`.
bool isSaved(const std::string& path);

/// Reads such a file, whatever is in it, by OSG's wrappers of classes but not by its readers of
/// bytes.
///
/// \param path of a file that is there
/// \param options for what the file names; with limits, see ReadLimits::of()
/// \return never null
/// \throw osgSkin::Error with the file and the reason
osg::ref_ptr<osg::Node> readSaved(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
