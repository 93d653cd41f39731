// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_KNOWNCLASSES_H
#define OSGSKINIMPORT_KNOWNCLASSES_H 1

#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Whether objects of a class may be read from a saved file: those that characters, their scenes
/// and animations are made of, and what `limits.classes` names. Others of OSG's believe numbers
/// that they read, and a class's name is the name of a library that OSG loads.
bool isKnownClass(const std::string& className, const ReadLimits& limits);

} // namespace osgSkin

#endif
