// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>

namespace plugin {

/// The build of a kit that a plug-in was compiled with, and the one loaded in the process.
struct KitBuild {
    const char* kit;         ///< name of the kit
    const char* compiled;    ///< the build of the headers, for example "0.2.0 (1a2b3c4d)"
    const char* (*loaded)(); ///< returns the build of the library; null if it is too old
};

/// Checks that a plug-in can use the loaded libraries. If a build folder or an installation
/// contains libraries of another version, class layouts differ and calls crash.
///
/// \param plugin name of the plug-in, for the warning
/// \param kits the kits that it links
/// \return false if a kit is of another build, after one OSG_WARN with both builds
bool mayUse(const char* plugin, std::initializer_list<KitBuild> kits);

} // namespace plugin

/// The KitBuild of a kit. Needs the kit's generated header, for example osgSkinBuild.h.
#define OSGSKIN_KIT_BUILD(KIT)                                                                     \
    plugin::KitBuild {                                                                             \
#KIT, k##KIT##Build, KIT##_build                                                           \
    }
