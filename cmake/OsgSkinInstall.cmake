# SPDX-License-Identifier: MIT
# Install rules for `cmake --install` and packages for `cpack -G DEB`: three components, one package
# each.
#   runtime  libosgSkin, libosgSkinRig, libosgSkinGpu and the serializers: everything that a saved
#            character needs (MIT)
#   plugin   osgSkinBind, osgSkinImport, osgSkinCharacter, the .skin plug-in, osgskinbake
#            (GPL-3.0-or-later)
#   dev      headers, CMake and pkg-config files of the kits that were built
# All paths are relative, so the installed tree can be moved.
include(CMakePackageConfigHelpers)

set(osgskin_cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/osgSkin")
set(osgskin_plugin_dir "${CMAKE_INSTALL_LIBDIR}/${OSGSKIN_OSG_PLUGINS}")

# osgskin_install_kit(NAME COMPONENT DESCRIPTION REQUIRES): installs a node kit with its CMake and
# pkg-config files. REQUIRES are names of other pkg-config files.
function(osgskin_install_kit name component description requires)
  install(TARGETS ${name} EXPORT ${name}Targets
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    COMPONENT ${component} NAMELINK_COMPONENT dev)
  install(EXPORT ${name}Targets NAMESPACE osgSkin:: DESTINATION "${osgskin_cmake_dir}"
    COMPONENT dev)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/nodekits/${name}/include/${name}"
    DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT dev)
  configure_file("${PROJECT_SOURCE_DIR}/cmake/kit.pc.in" "${PROJECT_BINARY_DIR}/${name}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${name}.pc"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT dev)
endfunction()

# The .pc files find the installed tree relative to themselves.
file(RELATIVE_PATH osgskin_pc_up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")

osgskin_install_kit(osgSkin runtime "${PROJECT_DESCRIPTION}" "openscenegraph-osgAnimation")
osgskin_install_kit(osgSkinRig runtime "Skeletons, motions and retargeting for osgSkin" "osgSkin")
osgskin_install_kit(osgSkinGpu runtime "Deforms on a graphics card for osgSkin" "osgSkinRig")
if(TARGET osgSkinBind)
  osgskin_install_kit(osgSkinBind plugin "Binds a skin to a skeleton for osgSkin" "osgSkinRig")
endif()
if(TARGET osgSkinImport)
  osgskin_install_kit(osgSkinImport plugin "Reads meshes, skeletons and motions for osgSkin"
    "osgSkinRig openscenegraph-osgDB")
endif()
if(TARGET osgSkinCharacter)
  osgskin_install_kit(osgSkinCharacter plugin "From a file to a character for osgSkin"
    "osgSkinBind osgSkinImport osgSkinGpu")
endif()
if(TARGET osgdb_serializers_osgskin)
  install(TARGETS osgdb_serializers_osgskin
    LIBRARY DESTINATION "${osgskin_plugin_dir}" COMPONENT runtime)
endif()
if(TARGET osgdb_skin)
  install(TARGETS osgdb_skin LIBRARY DESTINATION "${osgskin_plugin_dir}" COMPONENT plugin)
endif()
if(TARGET osgskinbake)
  file(RELATIVE_PATH osgskin_lib_from_bin "/${CMAKE_INSTALL_BINDIR}" "/${CMAKE_INSTALL_LIBDIR}")
  set_target_properties(osgskinbake PROPERTIES INSTALL_RPATH "$ORIGIN/${osgskin_lib_from_bin}")
  install(TARGETS osgskinbake RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT plugin)
endif()

write_basic_package_version_file("${PROJECT_BINARY_DIR}/osgSkinConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_SOURCE_DIR}/cmake/osgSkinConfig.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/OsgTargets.cmake"
  "${PROJECT_BINARY_DIR}/osgSkinConfigVersion.cmake"
  DESTINATION "${osgskin_cmake_dir}" COMPONENT dev)

set(CPACK_PACKAGE_NAME osgskin)
set(CPACK_PACKAGE_CONTACT "osgSkin developers <noreply@osgskin.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_COMPONENTS_ALL runtime dev)
set(CPACK_COMPONENT_DEV_DEPENDS runtime)
if(TARGET osgdb_skin)
  list(APPEND CPACK_COMPONENTS_ALL plugin)
  set(CPACK_COMPONENT_PLUGIN_DEPENDS runtime)
  list(APPEND CPACK_COMPONENT_DEV_DEPENDS plugin)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME "libosgskin${OSGSKIN_SOVERSION}")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libosgskin-dev)
set(CPACK_DEBIAN_PLUGIN_PACKAGE_NAME osgskin-plugin)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PLUGIN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libopenscenegraph-dev, libglm-dev")
# dpkg-shlibdeps finds the libraries that ours link; our own are in the build folder.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
set(CPACK_STRIP_FILES ON)
include(CPack)
