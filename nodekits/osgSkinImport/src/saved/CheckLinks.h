// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKLINKS_H
#define OSGSKINIMPORT_CHECKLINKS_H 1

#include "saved/SavedStream.h"

#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Refuses channels of animations that osgAnimation would link to what is of another kind by their
/// names, as rotations to a place: it has nothing to move then, and moves it.
/// \throw osgSkin::Error with the channel
void checkLinks(const SavedStream::IdentifierMap& objects, const ReadLimits& limits,
                const std::string& path);

} // namespace osgSkin

#endif
