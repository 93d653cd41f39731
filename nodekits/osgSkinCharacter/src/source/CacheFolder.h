// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace osgSkin {

/// Where users' programs keep what they can make again: osgSkin in XDG_CACHE_HOME, or in .cache of
/// the home folder (XDG Base Directory Specification). Empty where neither is known.
std::string cacheFolder();

} // namespace osgSkin
