# Installation of development files: headers for plugins, which need no build (component development),
# and libraries to embed (components metrics and methods). Headers are included as <loopbench/...>.
set(loopbench_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/loopbench)
target_include_directories(loopbench_core INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

# loopbench_development(<component> <export> <target>...)
function(loopbench_development component export)
  install(TARGETS ${ARGN} EXPORT ${export}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/loopbench COMPONENT ${component}
    ARCHIVE COMPONENT ${component})
  install(EXPORT ${export} NAMESPACE loopbench:: FILE ${export}.cmake
    DESTINATION ${loopbench_cmake_folder} COMPONENT ${component})
endfunction()
loopbench_development(development loopbenchTargets loopbench_core loopbench_plugin)
loopbench_development(metrics loopbenchMetrics loopbench_metrics)
loopbench_development(methods loopbenchMethods loopbench_methods loopbench_solvers)
install(FILES cmake/loopbenchConfig.cmake DESTINATION ${loopbench_cmake_folder} COMPONENT development)
file(WRITE ${PROJECT_BINARY_DIR}/plugin.hpp "#include \"harness/plugin/plugin.hpp\"\n")
install(FILES ${PROJECT_BINARY_DIR}/plugin.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/loopbench COMPONENT development)
