# Functions that define a library or a test.

# loopbench_headers(<name> HEADERS <header>... LINK <library>...)
# Precompiled headers: parsed once, and clang instantiates the templates that they use once. Sources still
# include what they use: clang-tidy and header verification build without precompiled headers.
# In a header of our own: CMake gives its own list of them an old time, so that a new one would build nothing again.
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/empty.cpp CONTENT "")
function(loopbench_headers name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK" ${ARGN})
  list(TRANSFORM ARG_HEADERS REPLACE "(.+)" "#include <\\1>\n")
  list(JOIN ARG_HEADERS "" text)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.hpp CONTENT "${text}" @ONLY)
  add_library(loopbench_${name} OBJECT ${PROJECT_BINARY_DIR}/empty.cpp)
  set_target_properties(loopbench_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_features(loopbench_${name} PRIVATE cxx_std_20)
  target_link_libraries(loopbench_${name} PRIVATE loopbench_warnings fmt::fmt ${ARG_LINK})
  target_include_directories(loopbench_${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_precompile_headers(loopbench_${name} PRIVATE ${PROJECT_BINARY_DIR}/${name}.hpp)
endfunction()
file(GLOB loopbench_core_headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/datasets/core/*.hpp)
set(loopbench_slow_headers Eigen/Cholesky Eigen/Core Eigen/Eigenvalues Eigen/Geometry Eigen/LU algorithm chrono filesystem fstream
  functional map memory optional set sstream string variant vector fmt/format.h ${loopbench_core_headers})
loopbench_headers(headers HEADERS ${loopbench_slow_headers} LINK Eigen3::Eigen)

# loopbench_library(<name> FOLDER <dir> [ONLY <regex>] [EXCEPT <regex>] [BATCH <n>] [HEADERS <precompiled>]
#                   [LINK <public>...] [PRIVATE <hidden>...])
# Contains every .hpp and .cpp below FOLDER; new files are added automatically. A batch of sources that are compiled as
# one has 10, or n: large ones compile what sources share less often, small ones leave less to compile after a change.
# Presets with batches of other sizes change n in proportion.
function(loopbench_library name)
  cmake_parse_arguments(ARG "" "FOLDER;ONLY;EXCEPT;BATCH;HEADERS" "LINK;PRIVATE" ${ARGN})
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${ARG_FOLDER}/*.hpp)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${ARG_FOLDER}/*.cpp)
  if(ARG_ONLY)
    list(FILTER headers INCLUDE REGEX "${ARG_ONLY}")
    list(FILTER sources INCLUDE REGEX "${ARG_ONLY}")
  endif()
  if(ARG_EXCEPT)
    list(FILTER headers EXCLUDE REGEX "${ARG_EXCEPT}")
    list(FILTER sources EXCLUDE REGEX "${ARG_EXCEPT}")
  endif()
  if(sources)
    set(scope PUBLIC)
    add_library(loopbench_${name} STATIC ${sources})
    target_link_libraries(loopbench_${name} PRIVATE
      $<BUILD_INTERFACE:loopbench_warnings> fmt::fmt ${ARG_PRIVATE})
    if(NOT ARG_HEADERS)
      set(ARG_HEADERS headers)
    endif()
    target_precompile_headers(loopbench_${name} REUSE_FROM loopbench_${ARG_HEADERS})
    if(ARG_BATCH AND CMAKE_UNITY_BUILD_BATCH_SIZE)
      math(EXPR batch "(${ARG_BATCH} * ${CMAKE_UNITY_BUILD_BATCH_SIZE} + 9) / 10")
      set_target_properties(loopbench_${name} PROPERTIES UNITY_BUILD_BATCH_SIZE ${batch})
    endif()
  else()
    set(scope INTERFACE)
    add_library(loopbench_${name} INTERFACE)
  endif()
  add_library(loopbench::${name} ALIAS loopbench_${name})
  target_sources(loopbench_${name} ${scope}
    FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${headers})
  target_compile_features(loopbench_${name} ${scope} cxx_std_20)
  target_link_libraries(loopbench_${name} ${scope} ${ARG_LINK})
  set_target_properties(loopbench_${name} PROPERTIES
    EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON VERIFY_INTERFACE_HEADER_SETS ON)
endfunction()

# loopbench_test(<name> SOURCES <file>... LINK <library>... [SHARDS <n>])
# One program, registered as <n> tests with a share of its cases each: starting a process takes longer
# than most cases, above all under a sanitizer. To run a single case, use --gtest_filter.
function(loopbench_test name)
  cmake_parse_arguments(ARG "" "SHARDS" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_SHARDS)
    set(ARG_SHARDS 1)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE loopbench_warnings GTest::gtest_main GTest::gmock ${ARG_LINK})
  target_precompile_headers(${name} REUSE_FROM loopbench_test_headers)
  target_compile_options(${name} PRIVATE ${LOOPBENCH_TEST_OPTIONS})
  target_compile_definitions(${name} PRIVATE
    LOOPBENCH_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  foreach(shard RANGE 1 ${ARG_SHARDS})
    math(EXPR index "${shard} - 1")
    set(test ${name}_${shard}_of_${ARG_SHARDS})
    if(ARG_SHARDS EQUAL 1)
      set(test ${name})
    endif()
    add_test(NAME ${test} COMMAND ${name})
    set_tests_properties(${test} PROPERTIES
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()
