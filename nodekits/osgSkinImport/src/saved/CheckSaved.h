// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKSAVED_H
#define OSGSKINIMPORT_CHECKSAVED_H 1

#include "saved/SavedStream.h"

#include <osgSkinImport/ReadLimits>

#include <osg/Node>

#include <cstddef>
#include <string>

namespace osgSkin {

/// Checks all that was read from a saved file, be it in the scene or not: geometries whose
/// primitives are none or name vertices that are not there, arrays and morph targets that are too
/// short, animations that are none, and nodes, callbacks and animations that OSG has dropped.
/// \throw osgSkin::Error with the file and the reason
void checkSavedObjects(const SavedStream::IdentifierMap& objects, const std::string& path);

/// Checks how much a scene has where nodes stand below several others, each time anew: a few
/// hundred bytes can name more than any traversal ends with.
/// \throw osgSkin::Error as above
void checkSavedScene(const osg::Node& scene, std::size_t bytes, const ReadLimits& limits,
                     const std::string& path);

} // namespace osgSkin

#endif
