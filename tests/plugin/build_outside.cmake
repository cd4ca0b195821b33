# Installs the COMPONENTS, then builds an external project against these only, and runs RUN if given.
set(prefix ${OUTSIDE}/prefix)
file(REMOVE_RECURSE ${prefix})
foreach(component IN LISTS COMPONENTS)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --component ${component}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
# In another folder, so that a header that is not installed is not found.
execute_process(COMMAND ${CMAKE_COMMAND} --fresh -S ${SOURCE} -B ${OUTSIDE}/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  -DCMAKE_CXX_EXTENSIONS=OFF -DCMAKE_BUILD_TYPE=${TYPE} -DCMAKE_CXX_FLAGS=${FLAGS}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${OUTSIDE}/build COMMAND_ERROR_IS_FATAL ANY)
if(RUN)
  execute_process(COMMAND ${OUTSIDE}/build/${RUN} COMMAND_ERROR_IS_FATAL ANY)
endif()
