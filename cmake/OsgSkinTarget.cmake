# SPDX-License-Identifier: MIT
# Settings shared by our own targets. They are never global, so they do not affect third-party code.

# The folder of a library or program in its own INSTALL_RPATH. Windows has none: it finds DLLs beside
# the program.
set(osgskin_origin "$ORIGIN")
if(APPLE)
  set(osgskin_origin "@loader_path")
endif()

# osgskin_settings(TARGET): language level, warnings, hidden symbols, sanitizers, coverage.
function(osgskin_settings target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  if(MSVC)
    # C4251, C4275: members and bases from other libraries without __declspec, as OSG's and std's.
    target_compile_options(${target} PRIVATE
      /W4 /wd4251 /wd4275 /permissive- /utf-8 /bigobj $<$<BOOL:${OSGSKIN_WERROR}>:/WX>)
    target_compile_definitions(${target} PRIVATE
      NOMINMAX _USE_MATH_DEFINES _CRT_SECURE_NO_WARNINGS)
  else()
    target_compile_options(${target} PRIVATE
      -Wall -Wextra -Wpedantic -Wshadow -Wconversion $<$<BOOL:${OSGSKIN_WERROR}>:-Werror>
      # Kernels ask for -O3: elsewhere it takes time to compile and gains nothing.
      $<$<CONFIG:Release>:-O2>)
    if(OSGSKIN_UNITY)
      # A unit has no main file, whose classes may have bases and members from unnamed namespaces.
      target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    endif()
  endif()
  if(OSGSKIN_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${OSGSKIN_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${OSGSKIN_SANITIZE})
    if(OSGSKIN_SANITIZE MATCHES undefined)
      target_compile_options(${target} PRIVATE -fno-sanitize-recover=undefined) # otherwise tests would still pass
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

# osgskin_unity(TARGET): with OSGSKIN_UNITY, compiles the sources of each folder of src as one unit. Most
# of a source's time is spent in OSG's headers. Sources that include CGAL or Highway stay alone: these
# are slow to compile, and should be compiled on several processors.
function(osgskin_unity target)
  if(NOT OSGSKIN_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    if(source MATCHES "^src/(.+)/[^/]+[.]cpp$")
      set(folder "${CMAKE_MATCH_1}")
      file(STRINGS "${source}" alone REGEX "#include [<\"](CGAL|hwy)/" LIMIT_COUNT 1)
      if(NOT alone)
        set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${folder}")
      endif()
    endif()
  endforeach()
endfunction()

# osgskin_batches(TARGET): with OSGSKIN_UNITY, compiles several small sources as one unit.
function(osgskin_batches target)
  if(OSGSKIN_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
  endif()
endfunction()

# osgskin_nodekit(NAME): settings of the library nodekits/NAME with the headers include/NAME.
function(osgskin_nodekit name)
  string(TOUPPER ${name} upper)
  osgskin_settings(${name})
  osgskin_unity(${name})
  target_compile_definitions(${name} PRIVATE ${upper}_LIBRARY)
  target_include_directories(${name} PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  # Sources include each other by folder: "pose/PoseKernel.h".
  target_include_directories(${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/src")
  set_target_properties(${name} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${OSGSKIN_SOVERSION} INSTALL_RPATH "${osgskin_origin}")
  if(NOT BUILD_SHARED_LIBS)
    target_compile_definitions(${name} PUBLIC OSGSKIN_STATIC)
  endif()
  osgskin_kit_build(${name})
  add_library(osgSkin::${name} ALIAS ${name})
  # The same objects, for tests of symbols that the library does not export.
  add_library(${name}Internals STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${name}>)
  set_target_properties(${name}Internals PROPERTIES LINKER_LANGUAGE CXX)
  target_include_directories(${name}Internals INTERFACE "${CMAKE_CURRENT_SOURCE_DIR}/src")
endfunction()

# The number at the end of the libraries' names, so that programs never load an incompatible
# version. Before 1.0.0 a minor version may change class layouts.
set(OSGSKIN_SOVERSION ${PROJECT_VERSION_MAJOR})
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(OSGSKIN_SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
endif()

# osgskin_kit_build(NAME): adds the kit's build to its library, and to NAMEBuild.h for plug-ins,
# which reject a library of another build (osgPlugin/common/KitCheck.h).
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

# osgskin_plugin(TARGET): an OSG plug-in in lib/osgPlugins-x.y.z, which OSG finds by
# OSG_LIBRARY_PATH; or an archive, which programs link (osgSkin/StaticPlugins).
set(OSGSKIN_PLUGIN_TYPE MODULE)
if(NOT BUILD_SHARED_LIBS)
  set(OSGSKIN_PLUGIN_TYPE STATIC)
endif()
function(osgskin_plugin target)
  set(osgskin_plugins "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
  set(prefix "")
  if(WIN32) # beside the DLLs; a debug build of OSG adds a d to names
    set(osgskin_plugins "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
    set_target_properties(${target} PROPERTIES DEBUG_POSTFIX d)
  endif()
  if(MINGW) # OSG adds this to the names of its plug-ins, too
    set(prefix mingw_)
  endif()
  osgskin_settings(${target})
  target_sources(${target} PRIVATE "${PROJECT_SOURCE_DIR}/osgPlugin/common/KitCheck.cpp")
  target_include_directories(${target} PRIVATE
    "${PROJECT_SOURCE_DIR}/osgPlugin/common" "${OSGSKIN_BUILD_HEADERS}")
  if(NOT BUILD_SHARED_LIBS)
    return()
  endif()
  set_target_properties(${target} PROPERTIES
    PREFIX "${prefix}" INSTALL_RPATH "${osgskin_origin}/.."
    LIBRARY_OUTPUT_DIRECTORY "${osgskin_plugins}/${OSGSKIN_OSG_PLUGINS}")
endfunction()

# osgskin_quickly_built(TARGET): builds a program with -O1. Its run time is spent in our kits, and
# GCC would need ten seconds to optimise CLI11.
function(osgskin_quickly_built target)
  if(NOT MSVC)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()
