# SPDX-License-Identifier: MIT
# osgskin_test(NAME SOURCES ... LINK ...): a GoogleTest program, each of its cases a CTest test.
#
# OSGSKIN_SHARED_DATA is where the optional third-party bodies and motions are looked for; a test
# that needs them skips with a message where they are missing.
function(osgskin_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES} "${PROJECT_SOURCE_DIR}/tests/support/TempFolder.cpp")
  osgskin_settings(${name})
  # Compiling takes longer than running: GCC's -O1 saves a quarter of the first.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests/support")
  target_link_libraries(${name} PRIVATE ${arg_LINK} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    OSGSKIN_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data"
    OSGSKIN_DATA="${PROJECT_SOURCE_DIR}/data"
    OSGSKIN_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
    PROPERTIES ENVIRONMENT "OSG_LIBRARY_PATH=${PROJECT_BINARY_DIR}/lib")
endfunction()
