# SPDX-License-Identifier: MIT
# find_package(osgSkin COMPONENTS osgSkinCharacter): a target osgSkin::NAME for each component and
# for the kits that it links. Components are osgSkin, osgSkinRig, osgSkinMotion, osgSkinGpu, osgSkinBind,
# osgSkinImport and osgSkinCharacter. The runtime (osgSkin, osgSkinRig, osgSkinMotion and osgSkinGpu) is always
# included. Static kits have their plug-ins as targets, too: osgSkin::osgdb_serializers_osgskin and,
# with osgSkinCharacter, osgSkin::osgdb_skin (see osgSkin/StaticPlugins).
include(CMakeFindDependencyMacro)
find_dependency(glm)
# OpenSceneGraph's targets come first, because ours link them.
include("${CMAKE_CURRENT_LIST_DIR}/OsgTargets.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/osgSkinStatic.cmake" OPTIONAL) # what static kits link
include("${CMAKE_CURRENT_LIST_DIR}/osgSkinTargets.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/osgSkinRigTargets.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/osgSkinMotionTargets.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/osgSkinGpuTargets.cmake")

set(osgskin_kits osgSkin osgSkinRig osgSkinMotion osgSkinGpu)
foreach(component IN LISTS osgSkin_FIND_COMPONENTS)
  if(component STREQUAL "osgSkinCharacter")
    list(APPEND osgskin_kits osgSkinBind osgSkinImport)
  endif()
  list(APPEND osgskin_kits ${component})
endforeach()
list(REMOVE_DUPLICATES osgskin_kits)
foreach(kit IN LISTS osgskin_kits)
  if(kit MATCHES "^osgSkin[A-Za-z]*$" AND EXISTS "${CMAKE_CURRENT_LIST_DIR}/${kit}Targets.cmake")
    include("${CMAKE_CURRENT_LIST_DIR}/${kit}Targets.cmake")
    set(osgSkin_${kit}_FOUND TRUE)
  else()
    set(osgSkin_${kit}_FOUND FALSE)
    if(osgSkin_FIND_REQUIRED_${kit})
      set(osgSkin_FOUND FALSE)
      set(osgSkin_NOT_FOUND_MESSAGE
          "${kit} was not built with this osgSkin, or is none of its components")
    endif()
  endif()
endforeach()
include("${CMAKE_CURRENT_LIST_DIR}/osgdb_serializers_osgskinmotionTargets.cmake" OPTIONAL)
include("${CMAKE_CURRENT_LIST_DIR}/osgdb_serializers_osgskinTargets.cmake" OPTIONAL)
if("osgSkinCharacter" IN_LIST osgskin_kits)
  include("${CMAKE_CURRENT_LIST_DIR}/osgdb_skinTargets.cmake" OPTIONAL)
endif()
unset(osgskin_kits)
