# Installs the development files, then builds an external project against these only.
set(prefix ${OUTSIDE}/prefix)
file(REMOVE_RECURSE ${prefix})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --component development
  COMMAND_ERROR_IS_FATAL ANY)
# In another folder, so that a header that is not installed is not found.
execute_process(COMMAND ${CMAKE_COMMAND} --fresh -S ${SOURCE} -B ${OUTSIDE}/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  -DCMAKE_CXX_EXTENSIONS=OFF -DCMAKE_BUILD_TYPE=${TYPE} -DCMAKE_CXX_FLAGS=${FLAGS}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${OUTSIDE}/build COMMAND_ERROR_IS_FATAL ANY)
