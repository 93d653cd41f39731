# SPDX-License-Identifier: MIT
# cmake -DKIT=osgSkin -DVERSION=0.2.0 -DHEADERS=FOLDER -DOUT=FOLDER -P KitBuild.cmake
#
# Writes OUT/osgSkinBuild.cpp, which goes into the kit's library, and OUT/osgSkinBuild.h for plug-ins:
# both hold the kit's build, its version and a digest of its public headers. Libraries and plug-ins
# whose headers differ must not meet in one process: their classes are laid out differently.
file(GLOB headers "${HEADERS}/*")
set(all "")
foreach(header IN LISTS headers)
  file(SHA256 "${header}" digest)
  string(APPEND all "${digest}")
endforeach()
string(SHA256 digest "${all}")
string(SUBSTRING "${digest}" 0 8 digest)
set(build "${VERSION} (${digest})")

file(CONFIGURE OUTPUT "${OUT}/${KIT}Build.h" @ONLY CONTENT [[
// SPDX-License-Identifier: MIT
// Made by cmake/KitBuild.cmake.
#pragma once

/// The build of @KIT@ that this is compiled with.
constexpr char k@KIT@Build[] = "@build@";

/// The build of the @KIT@ that is loaded. Weak: null where that is too old to know.
extern "C" __attribute__((weak)) const char* @KIT@_build();
]])
file(CONFIGURE OUTPUT "${OUT}/${KIT}Build.cpp" @ONLY CONTENT [[
// SPDX-License-Identifier: MIT
// Made by cmake/KitBuild.cmake.
extern "C" __attribute__((visibility("default"))) const char* @KIT@_build();
extern "C" const char* @KIT@_build() {
    return "@build@";
}
]])
