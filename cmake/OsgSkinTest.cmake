# SPDX-License-Identifier: MIT
# osgskin_test(NAME SOURCES ... LINK ...): a GoogleTest program; each of its cases is a CTest test.
#
# OSGSKIN_SHARED_DATA is the folder of the optional third-party bodies and motions. Tests that need
# them are skipped with a message if they are missing.
function(osgskin_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES} "${PROJECT_SOURCE_DIR}/tests/support/TempFolder.cpp")
  osgskin_settings(${name})
  # Compiling takes longer than running; -O1 saves a quarter of GCC's time.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  osgskin_precompile(${name})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests/support")
  target_link_libraries(${name} PRIVATE ${arg_LINK} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    OSGSKIN_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data"
    OSGSKIN_DATA="${PROJECT_SOURCE_DIR}/data"
    OSGSKIN_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
    PROPERTIES ENVIRONMENT "OSG_LIBRARY_PATH=${PROJECT_BINARY_DIR}/lib")
endfunction()

# osgskin_precompile(TARGET): precompiles the headers that take tests most of their time.
function(osgskin_precompile target)
  target_precompile_headers(${target} PRIVATE <gtest/gtest.h> <osg/Geometry> <osgAnimation/Skeleton>
    <osgDB/ReadFile> <algorithm> <cmath> <filesystem> <fstream> <functional> <map> <sstream> <string> <vector>)
endfunction()
