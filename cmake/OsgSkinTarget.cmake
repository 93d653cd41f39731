# SPDX-License-Identifier: MIT
# Settings shared by our own targets; never global, so third-party code is left alone.

# osgskin_settings(TARGET): language level, warnings, hidden symbols, sanitizers, coverage.
function(osgskin_settings target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(OSGSKIN_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(OSGSKIN_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${OSGSKIN_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${OSGSKIN_SANITIZE})
    if(OSGSKIN_SANITIZE MATCHES undefined)
      target_compile_options(${target} PRIVATE -fno-sanitize-recover=undefined) # which tests would pass with
      target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS)
    endif()
    get_target_property(type ${target} TYPE)
    if(OSGSKIN_SANITIZE MATCHES address AND type STREQUAL EXECUTABLE)
      target_sources(${target} PRIVATE "${PROJECT_SOURCE_DIR}/tests/support/DriverLeaks.cpp")
      target_link_options(${target} PRIVATE
        -Wl,--export-dynamic-symbol=dlclose,--export-dynamic-symbol=__lsan_default_suppressions)
    endif()
  endif()
  if(OSGSKIN_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage -fprofile-update=atomic)
    target_link_options(${target} PRIVATE --coverage)
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
  # Sources name each other by room: "pose/PoseKernel.h".
  target_include_directories(${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/src")
  set_target_properties(${name} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${OSGSKIN_SOVERSION} INSTALL_RPATH "$ORIGIN")
  osgskin_kit_build(${name})
  add_library(osgSkin::${name} ALIAS ${name})
  # The same objects for tests of what the library does not export.
  add_library(${name}Internals STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${name}>)
  set_target_properties(${name}Internals PROPERTIES LINKER_LANGUAGE CXX)
  target_include_directories(${name}Internals INTERFACE "${CMAKE_CURRENT_SOURCE_DIR}/src")
endfunction()

# The number that libraries' names end with: layouts that differ never meet. Before 1.0.0 they may
# change with the second number of the version.
set(OSGSKIN_SOVERSION ${PROJECT_VERSION_MAJOR})
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(OSGSKIN_SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
endif()

# osgskin_kit_build(NAME): puts the kit's build into its library, and into NAMEBuild.h for plug-ins,
# which refuse a library of another build (osgPlugin/common/KitCheck.h).
set(OSGSKIN_BUILD_HEADERS "${PROJECT_BINARY_DIR}/kit-build")
function(osgskin_kit_build name)
  set(script "${PROJECT_SOURCE_DIR}/cmake/KitBuild.cmake")
  set(folder "${CMAKE_CURRENT_SOURCE_DIR}/include/${name}")
  file(GLOB headers "${folder}/*")
  set(made "${OSGSKIN_BUILD_HEADERS}/${name}Build.h" "${OSGSKIN_BUILD_HEADERS}/${name}Build.cpp")
  add_custom_command(OUTPUT ${made}
    COMMAND "${CMAKE_COMMAND}" -DKIT=${name} -DVERSION=${PROJECT_VERSION} "-DHEADERS=${folder}"
            "-DOUT=${OSGSKIN_BUILD_HEADERS}" -P "${script}"
    DEPENDS ${headers} "${script}" VERBATIM)
  target_sources(${name} PRIVATE ${made})
endfunction()

# osgskin_plugin(TARGET): an OSG plug-in in lib/osgPlugins-x.y.z, found through OSG_LIBRARY_PATH.
function(osgskin_plugin target)
  osgskin_settings(${target})
  target_sources(${target} PRIVATE "${PROJECT_SOURCE_DIR}/osgPlugin/common/KitCheck.cpp")
  target_include_directories(${target} PRIVATE
    "${PROJECT_SOURCE_DIR}/osgPlugin/common" "${OSGSKIN_BUILD_HEADERS}")
  set_target_properties(${target} PROPERTIES
    PREFIX "" INSTALL_RPATH "$ORIGIN/.."
    LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib/${OSGSKIN_OSG_PLUGINS}")
endfunction()

# osgskin_quickly_built(TARGET): a program whose time goes into our kits: GCC spends ten seconds to inline
# CLI11 at its best.
function(osgskin_quickly_built target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()
