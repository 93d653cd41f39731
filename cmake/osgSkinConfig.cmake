# SPDX-License-Identifier: MIT
# find_package(osgSkin COMPONENTS osgSkin osgSkinBind osgSkinImport): a target osgSkin::NAME for each.
# The runtime, osgSkin::osgSkin, is always there.
include(CMakeFindDependencyMacro)
find_dependency(glm)
# OpenSceneGraph's targets first: ours name them.
include("${CMAKE_CURRENT_LIST_DIR}/OsgTargets.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/osgSkinTargets.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/osgSkinRigTargets.cmake")

set(osgSkin_osgSkin_FOUND TRUE)
foreach(component IN LISTS osgSkin_FIND_COMPONENTS)
  if(component STREQUAL "osgSkin")
    continue()
  endif()
  if(component MATCHES "^osgSkin[A-Za-z]+$" AND
     EXISTS "${CMAKE_CURRENT_LIST_DIR}/${component}Targets.cmake")
    include("${CMAKE_CURRENT_LIST_DIR}/${component}Targets.cmake")
    set(osgSkin_${component}_FOUND TRUE)
  else()
    set(osgSkin_${component}_FOUND FALSE)
    if(osgSkin_FIND_REQUIRED_${component})
      set(osgSkin_FOUND FALSE)
      set(osgSkin_NOT_FOUND_MESSAGE
          "${component} was not built with this osgSkin, or is none of its components")
    endif()
  endif()
endforeach()
