# SPDX-License-Identifier: MIT
# OpenSceneGraph's Debian package has no CMake configuration. Wrap the results of its find modules
# in imported targets OSG::osg, OSG::osgDB, ... so that link lines contain no absolute paths.

find_package(OpenThreads REQUIRED)
if(NOT TARGET OSG::OpenThreads)
  add_library(OSG::OpenThreads INTERFACE IMPORTED)
  set_target_properties(OSG::OpenThreads PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${OPENTHREADS_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES OpenThreads)
endif()

# osgskin_osg_target(NAME DEPENDENCY...)
function(osgskin_osg_target name)
  if(TARGET OSG::${name})
    return()
  endif()
  find_package(${name} REQUIRED)
  string(TOUPPER ${name} upper)
  add_library(OSG::${name} INTERFACE IMPORTED)
  set(links ${name})
  foreach(dependency IN LISTS ARGN)
    list(APPEND links OSG::${dependency})
  endforeach()
  set_target_properties(OSG::${name} PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${${upper}_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${links}")
endfunction()

osgskin_osg_target(osg OpenThreads)
osgskin_osg_target(osgUtil osg)
osgskin_osg_target(osgDB osg osgUtil)
osgskin_osg_target(osgText osgDB)
osgskin_osg_target(osgGA osgDB)
osgskin_osg_target(osgViewer osgGA osgText)
osgskin_osg_target(osgShadow osgUtil)

osgskin_osg_target(osgAnimation osgDB osgText osgGA osgViewer)

# The name of the folder in which this version of OSG finds plug-ins.
file(STRINGS "${OSG_INCLUDE_DIR}/osg/Version" osgskin_version_lines
     REGEX "#define OPENSCENEGRAPH_(MAJOR|MINOR|PATCH)_VERSION")
foreach(part MAJOR MINOR PATCH)
  string(REGEX REPLACE ".*OPENSCENEGRAPH_${part}_VERSION +([0-9]+).*" "\\1"
         OSG_VERSION_${part} "${osgskin_version_lines}")
endforeach()
set(OSGSKIN_OSG_PLUGINS "osgPlugins-${OSG_VERSION_MAJOR}.${OSG_VERSION_MINOR}.${OSG_VERSION_PATCH}")
