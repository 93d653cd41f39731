# SPDX-License-Identifier: MIT
# Untested. An overlay port of the sources that it lies in:
#   vcpkg install osgskin --overlay-ports=cmake/vcpkg
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
vcpkg_check_linkage(ONLY_DYNAMIC_LIBRARY) # OSG loads the plug-ins
vcpkg_check_features(OUT_FEATURE_OPTIONS FEATURE_OPTIONS FEATURES
  import OSGSKIN_IMPORT
  bind OSGSKIN_BIND
  bind OSGSKIN_EXAMPLES)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${FEATURE_OPTIONS} -DOSGSKIN_TESTS=OFF -DOSGSKIN_BENCH=OFF)
vcpkg_cmake_install()
vcpkg_copy_pdbs()
vcpkg_cmake_config_fixup(PACKAGE_NAME osgskin CONFIG_PATH lib/cmake/osgSkin)
vcpkg_fixup_pkgconfig()
if("bind" IN_LIST FEATURES)
  vcpkg_copy_tools(AUTO_CLEAN TOOL_NAMES
    osgskinbake osgskincrowd osgskinfigures osgskinrecipes osgskinthrow osgskintwist osgskinviewer)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/LICENSES/MIT.txt"
  "${SOURCE_PATH}/LICENSES/GPL-3.0-or-later.txt" "${SOURCE_PATH}/LICENSES/CC0-1.0.txt")
