# SPDX-License-Identifier: MIT
# Install rules for `cmake --install`, by component, of which debian/ makes packages (cmake/packages.sh).
#   component    package                 licence  contents
#   runtime      libosgskin0.4           MIT      libosgSkin, libosgSkinRig, libosgSkinMotion, libosgSkinGpu
#   serializers  osgskin-serializers     MIT      .osgt, .osgb, .osgx; with runtime, everything that
#                                                 a saved character needs
#   import       libosgskinimport0.4     MIT      libosgSkinImport
#   dev          libosgskin-dev          MIT      headers, CMake and pkg-config files of these kits
#   bind         libosgskinbind0.4       MIT      libosgSkinBind, libosgSkinCharacter
#   plugin       osgskin-plugin          MIT      the .skin plug-in
#   programs     osgskin-tools           MIT      the programs, their man pages, the thrower
#   binder       osgskin-binder          GPL      the plug-in that binds without painted weights
# All paths are relative, so the installed tree can be moved.
include(CMakePackageConfigHelpers)

set(osgskin_cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/osgSkin")
set(osgskin_plugin_dir "${CMAKE_INSTALL_LIBDIR}/${OSGSKIN_OSG_PLUGINS}")
if(WIN32)
  set(osgskin_plugin_dir "${CMAKE_INSTALL_BINDIR}/${OSGSKIN_OSG_PLUGINS}")
endif()

# osgskin_install_kit(NAME COMPONENT DEV DESCRIPTION REQUIRES [INSIDE]): installs a node kit with its
# CMake and pkg-config files. DEV is the component of these; REQUIRES are names of other pkg-config
# files, INSIDE those of libraries that the kit's sources alone use: who links an archive needs them.
function(osgskin_install_kit name component dev description requires)
  set(cflags "")
  set(libs "")
  if(NOT BUILD_SHARED_LIBS)
    list(JOIN ARGN " " inside)
    set(requires "${requires} ${inside}")
    set(cflags " -DOSGSKIN_STATIC")
    if(osgskin_meshoptimizer AND name MATCHES "Gpu|Import") # which has no pkg-config file
      set(libs " -lmeshoptimizer")
    endif()
  endif()
  install(TARGETS ${name} EXPORT ${name}Targets
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${component} NAMELINK_COMPONENT ${dev}
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${dev} # Windows: the import library
    RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT ${component})
  install(EXPORT ${name}Targets NAMESPACE osgSkin:: DESTINATION "${osgskin_cmake_dir}"
    COMPONENT ${dev})
  if(EXISTS "${PROJECT_SOURCE_DIR}/nodekits/${name}")
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/nodekits/${name}/include/${name}"
      DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT ${dev})
  endif()
  configure_file("${PROJECT_SOURCE_DIR}/cmake/kit.pc.in" "${PROJECT_BINARY_DIR}/${name}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${name}.pc"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT ${dev})
endfunction()

# osgskin_install_program(NAME PURPOSE): installs a program, and its man page if help2man is there at
# that time.
function(osgskin_install_program name purpose)
  set_target_properties(${name} PROPERTIES INSTALL_RPATH "${osgskin_origin}/${osgskin_lib_from_bin}")
  install(TARGETS ${name} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT programs)
  if(CMAKE_CROSSCOMPILING OR OSGSKIN_SANITIZE)
    return()
  endif()
  install(CODE "
    find_program(OSGSKIN_HELP2MAN help2man)
    if(OSGSKIN_HELP2MAN)
      set(page \"${PROJECT_BINARY_DIR}/man/${name}.1\")
      file(MAKE_DIRECTORY \"${PROJECT_BINARY_DIR}/man\")
      execute_process(COMMAND \"\${OSGSKIN_HELP2MAN}\" --no-info \"--name=${purpose}\"
        \"--output=\${page}\" \"$<TARGET_FILE:${name}>\" RESULT_VARIABLE failed)
      if(failed)
        message(FATAL_ERROR \"help2man cannot make \${page}\")
      endif()
      file(INSTALL \"\${page}\"
        DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
    endif()" COMPONENT programs)
endfunction()

# The .pc files find the installed tree relative to themselves, the programs the libraries.
file(RELATIVE_PATH osgskin_pc_up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
file(RELATIVE_PATH osgskin_lib_from_bin "/${CMAKE_INSTALL_BINDIR}" "/${CMAKE_INSTALL_LIBDIR}")

foreach(package TBB meshoptimizer draco) # used where they are found
  set(osgskin_${package} "")
  if(${package}_DIR)
    set(osgskin_${package} ${package})
  endif()
endforeach()
string(TOLOWER "${osgskin_TBB}" osgskin_tbb) # its pkg-config file
osgskin_install_kit(osgSkin runtime dev "${PROJECT_DESCRIPTION}" "openscenegraph-osgAnimation"
  openscenegraph-osgUtil ${osgskin_tbb})
osgskin_install_kit(osgSkinRig runtime dev "Skeletons, joint names and retargeting for osgSkin" "osgSkin")
osgskin_install_kit(osgSkinMotion runtime dev "Clips, walkers, springs and feet for osgSkin" "osgSkinRig")
osgskin_install_kit(osgSkinGpu runtime dev "Deforms on a graphics card for osgSkin" "osgSkinMotion" gl)
if(TARGET osgSkinImport)
  osgskin_install_kit(osgSkinImport import dev "Reads meshes, skeletons and motions for osgSkin"
    "osgSkinMotion openscenegraph-osgDB" assimp zlib ${osgskin_draco})
endif()
if(TARGET osgSkinBind)
  osgskin_install_kit(osgSkinBind bind dev "Binds a skin to a skeleton for osgSkin" "osgSkinRig"
    openscenegraph-osgDB)
endif()
if(TARGET osgSkinCharacter)
  osgskin_install_kit(osgSkinCharacter bind dev "From a file to a character for osgSkin"
    "osgSkinBind osgSkinImport osgSkinGpu")
endif()
if(BUILD_SHARED_LIBS)
  if(TARGET osgdb_serializers_osgskin)
    install(TARGETS osgdb_serializers_osgskin osgdb_serializers_osgskinmotion
      LIBRARY DESTINATION "${osgskin_plugin_dir}" COMPONENT serializers)
  endif()
  if(TARGET osgdb_skin)
    install(TARGETS osgdb_skin LIBRARY DESTINATION "${osgskin_plugin_dir}" COMPONENT plugin)
  endif()
else()
  if(TARGET osgdb_serializers_osgskin)
    osgskin_install_kit(osgdb_serializers_osgskinmotion serializers dev "Reads and writes walkers"
      "osgSkinMotion openscenegraph-osgDB")
    osgskin_install_kit(osgdb_serializers_osgskin serializers dev "Reads and writes saved characters"
      "osgdb_serializers_osgskinmotion")
  endif()
  if(TARGET osgdb_skin)
    osgskin_install_kit(osgdb_skin plugin dev "Lets osgDB read .skin files"
      "osgSkinCharacter osgdb_serializers_osgskin")
  endif()
  # The packages whose targets our archives name, for osgSkinConfig.cmake.
  set(packages OpenGL ${osgskin_TBB} ${osgskin_meshoptimizer})
  if(TARGET osgSkinImport)
    list(APPEND packages assimp ZLIB nlohmann_json ${osgskin_draco})
  endif()
  list(TRANSFORM packages REPLACE "(.+)" "find_dependency(\\1)\n")
  string(CONCAT packages ${packages})
  file(WRITE "${PROJECT_BINARY_DIR}/osgSkinStatic.cmake" "${packages}")
  install(FILES "${PROJECT_BINARY_DIR}/osgSkinStatic.cmake" DESTINATION "${osgskin_cmake_dir}"
    COMPONENT dev)
endif()
if(TARGET osgdb_binder_osgskin)
  install(TARGETS osgdb_binder_osgskin
    LIBRARY DESTINATION "${osgskin_plugin_dir}" COMPONENT binder)
endif()
if(TARGET osgskinbake)
  osgskin_install_program(osgskinbake "write a character's posed skin as meshes")
  osgskin_install_program(osgskincrowd "show many characters, each in its own phase of its own clip")
  osgskin_install_program(osgskinrecipes "show short programs for usual tasks")
  osgskin_install_program(osgskinthrow "show a figure that throws a ball")
  osgskin_install_program(osgskinviewer "play a character and show how its skin is bound")
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/data/" DESTINATION "${CMAKE_INSTALL_DATADIR}/osgskin"
    COMPONENT programs FILES_MATCHING PATTERN "*.skin" PATTERN "*.obj" PATTERN "*.mtl" PATTERN "*.bvh"
    PATTERN generator EXCLUDE)
endif()

write_basic_package_version_file("${PROJECT_BINARY_DIR}/osgSkinConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_SOURCE_DIR}/cmake/osgSkinConfig.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/OsgTargets.cmake"
  "${PROJECT_BINARY_DIR}/osgSkinConfigVersion.cmake"
  DESTINATION "${osgskin_cmake_dir}" COMPONENT dev)

# osgskin_install_licences(COMPONENT [LICENCE...]): every component brings them, since each may be passed on alone.
function(osgskin_install_licences component)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT ${component})
  foreach(licence MIT Apache-2.0 NOTICES ${ARGN})
    install(FILES "${PROJECT_SOURCE_DIR}/LICENSES/${licence}.txt" DESTINATION "${CMAKE_INSTALL_DOCDIR}/LICENSES"
      COMPONENT ${component})
  endforeach()
endfunction()
foreach(component runtime serializers import dev bind plugin)
  osgskin_install_licences(${component})
endforeach()
if(TARGET osgskinbake)
  osgskin_install_licences(programs CC0-1.0)
endif()
if(TARGET osgdb_binder_osgskin)
  osgskin_install_licences(binder GPL-3.0-or-later)
endif()
