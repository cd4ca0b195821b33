# Installs what other programs use, then builds an external project against it, and with RUN (a program and its
# arguments) checks that it prints PRINTS, also when pkg-config names the libraries.
set(prefix ${OUTSIDE}/prefix)
file(REMOVE_RECURSE ${prefix})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --component development
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
# In another folder, so that a header that is not installed is not found.
execute_process(COMMAND ${CMAKE_COMMAND} --fresh -S ${SOURCE} -B ${OUTSIDE}/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  -DCMAKE_CXX_EXTENSIONS=OFF -DCMAKE_BUILD_TYPE=${TYPE} -DCMAKE_CXX_FLAGS=${FLAGS}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${OUTSIDE}/build COMMAND_ERROR_IS_FATAL ANY)

function(run program)
  execute_process(COMMAND ${program} ${ARGN} OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
  if(NOT printed STREQUAL "${PRINTS}\n")
    message(FATAL_ERROR "${program} printed '${printed}', expected '${PRINTS}'")
  endif()
endfunction()
if(RUN)
  list(POP_FRONT RUN program)
  run(${OUTSIDE}/build/${program} ${RUN})
  find_program(pkg_config pkg-config)
  if(pkg_config)
    file(GLOB_RECURSE pc ${prefix}/*/loopbench.pc)
    cmake_path(GET pc PARENT_PATH folder)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${folder}
      ${pkg_config} --cflags --libs "loopbench >= 0.3" OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${FLAGS} ${flags}")
    execute_process(COMMAND ${CXX} -std=c++20 ${SOURCE}/${program}.cpp -o ${OUTSIDE}/by_pkg_config ${flags}
      COMMAND_ERROR_IS_FATAL ANY)
    run(${OUTSIDE}/by_pkg_config ${RUN})
  endif()
endif()
