# SPDX-License-Identifier: MIT
# osgskin_test(NAME [SLOW] SOURCES ... LINK ...): a GoogleTest program; each of its cases is a CTest
# test. Without SLOW, tests/run builds and runs it also without --all.
#
# OSGSKIN_SHARED_DATA is the folder of the optional third-party bodies and motions. Tests that need
# them are skipped with a message if they are missing.
function(osgskin_test name)
  cmake_parse_arguments(arg "SLOW" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES} "${PROJECT_SOURCE_DIR}/tests/support/TempFolder.cpp")
  set(label slow)
  if(NOT arg_SLOW)
    set(label quick)
    add_dependencies(quick_tests ${name})
  endif()
  osgskin_settings(${name})
  osgskin_precompile(${name})
  if(OSGSKIN_UNITY)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 4)
  endif()
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests/support")
  target_link_libraries(${name} PRIVATE ${arg_LINK} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    OSGSKIN_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data"
    OSGSKIN_DATA="${PROJECT_SOURCE_DIR}/data"
    OSGSKIN_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${label} ENVIRONMENT "OSG_LIBRARY_PATH=${PROJECT_BINARY_DIR}/lib")
endfunction()

# osgskin_slow_tests(NAME...): at the end of a folder, makes its tests by add_test() slow, except those named.
function(osgskin_slow_tests)
  get_property(tests DIRECTORY PROPERTY TESTS)
  list(REMOVE_ITEM tests "" ${ARGN})
  set_property(TEST ${tests} APPEND PROPERTY LABELS slow)
endfunction()

# osgskin_precompile(TARGET): saves GCC half of the time that it needs for a test program, which is
# more than that needs to run: -O1, and the headers that take most of it, precompiled once for all.
function(osgskin_precompile target)
  set(optimise $<$<CONFIG:Release>:-O1>)
  if(NOT TARGET osgskin_precompiled)
    # A program, because GCC tells headers for programs and for libraries apart.
    set(source "${PROJECT_BINARY_DIR}/precompiled.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "int main() {}\n" @ONLY)
    add_executable(osgskin_precompiled "${source}")
    osgskin_settings(osgskin_precompiled)
    target_compile_options(osgskin_precompiled PRIVATE ${optimise})
    target_link_libraries(osgskin_precompiled
      PRIVATE GTest::gtest OSG::osg OSG::osgAnimation OSG::osgDB)
    target_precompile_headers(osgskin_precompiled PRIVATE <gtest/gtest.h> <osg/Geometry>
      <osgAnimation/Skeleton> <osgDB/ReadFile> <algorithm> <cmath> <filesystem> <fstream>
      <functional> <map> <sstream> <string> <vector>)
  endif()
  target_compile_options(${target} PRIVATE ${optimise})
  target_precompile_headers(${target} REUSE_FROM osgskin_precompiled)
endfunction()
