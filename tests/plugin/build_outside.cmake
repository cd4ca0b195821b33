# Installs what a plugin needs, then builds a stranger's project against that alone.
set(prefix ${OUTSIDE}/prefix)
file(REMOVE_RECURSE ${prefix})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --component development
  COMMAND_ERROR_IS_FATAL ANY)
# Elsewhere and out of reach of this tree: a header that is not installed must be missed.
execute_process(COMMAND ${CMAKE_COMMAND} --fresh -S ${SOURCE} -B ${OUTSIDE}/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  -DCMAKE_CXX_EXTENSIONS=OFF -DCMAKE_BUILD_TYPE=${TYPE} -DCMAKE_CXX_FLAGS=${FLAGS}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${OUTSIDE}/build COMMAND_ERROR_IS_FATAL ANY)
