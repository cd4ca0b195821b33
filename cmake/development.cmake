# What other programs use, in this tree and installed (component development): loopbench::loopbench, the libraries with
# the umbrella header <loopbench/loopbench.hpp>, and loopbench::plugin, the same with <loopbench/plugin.hpp>.
add_library(loopbench_library INTERFACE)
add_library(loopbench::loopbench ALIAS loopbench_library)
target_link_libraries(loopbench_library INTERFACE loopbench::datasets loopbench::methods loopbench::metrics)
target_sources(loopbench_library INTERFACE
  FILE_SET umbrella TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include
  FILES ${PROJECT_SOURCE_DIR}/include/loopbench/loopbench.hpp)
add_library(loopbench_plugin INTERFACE)
add_library(loopbench::plugin ALIAS loopbench_plugin)
target_link_libraries(loopbench_plugin INTERFACE loopbench::loopbench)
# Every cell loads the plugin: functions of its own that are bound when it is linked are not searched for in each cell.
target_link_options(loopbench_plugin INTERFACE LINKER:-Bsymbolic)
target_sources(loopbench_plugin INTERFACE
  FILE_SET umbrella TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include
  FILES ${PROJECT_SOURCE_DIR}/include/loopbench/plugin.hpp
  FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${PROJECT_SOURCE_DIR}/harness/sweep/catalogue/plugin.hpp)
set_target_properties(loopbench_library PROPERTIES EXPORT_NAME loopbench VERIFY_INTERFACE_HEADER_SETS ON)
set_target_properties(loopbench_plugin PROPERTIES EXPORT_NAME plugin VERIFY_INTERFACE_HEADER_SETS ON)
# In this tree, links make <loopbench/datasets/...> the same files.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include/loopbench)
foreach(folder datasets methods metrics harness)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${PROJECT_BINARY_DIR}/include/loopbench/${folder} SYMBOLIC)
endforeach()
target_include_directories(loopbench_core INTERFACE
  $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

install(TARGETS loopbench_core loopbench_datasets loopbench_solvers loopbench_methods loopbench_metrics
    loopbench_compression loopbench_library loopbench_plugin
  EXPORT loopbenchTargets
  ARCHIVE COMPONENT development
  FILE_SET umbrella DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/loopbench COMPONENT development)
set(loopbench_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/loopbench)
install(EXPORT loopbenchTargets NAMESPACE loopbench:: DESTINATION ${loopbench_cmake_folder} COMPONENT development)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/loopbenchConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES cmake/loopbenchConfig.cmake ${PROJECT_BINARY_DIR}/loopbenchConfigVersion.cmake
  DESTINATION ${loopbench_cmake_folder} COMPONENT development)
# The folder of loopbench.pc finds the others, so that the installed tree can be moved.
file(RELATIVE_PATH loopbench_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/loopbench.pc.in loopbench.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/loopbench.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
