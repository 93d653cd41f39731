# SPDX-License-Identifier: MIT
# Settings shared by our own targets; never global, so third-party code is left alone.

# osgskin_settings(TARGET): language level, warnings, hidden symbols, sanitizers.
function(osgskin_settings target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(OSGSKIN_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(OSGSKIN_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${OSGSKIN_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${OSGSKIN_SANITIZE})
  endif()
  set_target_properties(${target} PROPERTIES
    CXX_EXTENSIONS OFF
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON)
endfunction()

# osgskin_nodekit(NAME HEADERS... ): a shared library nodekits/NAME with include/NAME headers.
function(osgskin_nodekit name)
  string(TOUPPER ${name} upper)
  osgskin_settings(${name})
  target_compile_definitions(${name} PRIVATE ${upper}_LIBRARY)
  target_include_directories(${name} PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  # Sources name each other by room: "pose/SplitUnit.h".
  target_include_directories(${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/src")
  set_target_properties(${name} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR} INSTALL_RPATH "$ORIGIN")
  add_library(osgSkin::${name} ALIAS ${name})
endfunction()

# osgskin_plugin(TARGET): an OSG plug-in in lib/osgPlugins-x.y.z, found through OSG_LIBRARY_PATH.
function(osgskin_plugin target)
  osgskin_settings(${target})
  set_target_properties(${target} PROPERTIES
    PREFIX "" INSTALL_RPATH "$ORIGIN/.."
    LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib/${OSGSKIN_OSG_PLUGINS}")
endfunction()
