// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>

namespace plugin {

/// One of our libraries as a plug-in was compiled with it and as the process has it.
struct KitBuild {
    const char* kit;         ///< its name
    const char* compiled;    ///< the build of its headers, like "0.2.0 (1a2b3c4d)"
    const char* (*loaded)(); ///< gives that of the library; null: it is too old to tell
};

/// Whether a plug-in may use the libraries that it meets: where a build folder or an installation
/// holds leftovers of another version, classes are laid out differently and calls crash.
///
/// \param plugin its name, for the warning
/// \param kits that it links
/// \return false, after one OSG_WARN that names both builds, where one is of another build
bool mayUse(const char* plugin, std::initializer_list<KitBuild> kits);

} // namespace plugin

/// The entry for a kit whose generated header (osgSkinBuild.h) is included.
#define OSGSKIN_KIT_BUILD(KIT)                                                                     \
    plugin::KitBuild {                                                                             \
#KIT, k##KIT##Build, KIT##_build                                                           \
    }
