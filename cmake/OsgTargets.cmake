# SPDX-License-Identifier: MIT
# OpenSceneGraph has no CMake configuration. Wrap the results of CMake's find modules in imported
# targets OSG::osg, OSG::osgDB, ..., which are linked by the paths that were found: CMAKE_PREFIX_PATH
# or OSG_DIR choose among several OpenSceneGraphs. The installed package includes this file, too, and
# its targets name OSG's only as OSG::osg, so it contains no path of the OpenSceneGraph that built it.

# osgskin_osg_target(NAME DEPENDENCY...)
function(osgskin_osg_target name)
  if(TARGET OSG::${name})
    return()
  endif()
  find_package(${name} REQUIRED)
  string(TOUPPER ${name} upper)
  add_library(OSG::${name} UNKNOWN IMPORTED)
  set(links "")
  foreach(dependency IN LISTS ARGN)
    list(APPEND links OSG::${dependency})
  endforeach()
  set_target_properties(OSG::${name} PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${${upper}_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${links}")
  foreach(config RELEASE DEBUG)
    if(${upper}_LIBRARY_${config})
      set_property(TARGET OSG::${name} APPEND PROPERTY IMPORTED_CONFIGURATIONS ${config})
      set_target_properties(OSG::${name} PROPERTIES
        IMPORTED_LOCATION_${config} "${${upper}_LIBRARY_${config}}")
    endif()
  endforeach()
endfunction()
osgskin_osg_target(OpenThreads)
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
