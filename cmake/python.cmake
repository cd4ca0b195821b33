# The compiled module of the Python package, if python3-dev, python3-numpy and pybind11-dev are installed. Not
# under sanitizers, whose runtime the interpreter would have to load.
set(loopbench_python_default ON)
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(loopbench_python_default OFF)
endif()
option(LOOPBENCH_PYTHON "Build the Python module if Python, numpy and pybind11 are found" ${loopbench_python_default})

file(GLOB loopbench_python_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/harness/python/loopbench/*.py
  ${PROJECT_SOURCE_DIR}/harness/python/loopbench/*.pyi ${PROJECT_SOURCE_DIR}/harness/python/loopbench/py.typed)
set(loopbench_site lib/python3/dist-packages/loopbench)
install(FILES ${loopbench_python_files} DESTINATION ${loopbench_site} COMPONENT python)
# The program starts render.py for figures.
install(FILES ${loopbench_python_files} COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/loopbench/python/loopbench)
# The wheel (cmake/loopbench_wheel.py adds its metadata): the package, the program, configs and render.py.
set(loopbench_wheel loopbench-${PROJECT_VERSION}.data)
install(FILES ${loopbench_python_files} DESTINATION loopbench COMPONENT wheel EXCLUDE_FROM_ALL)
install(FILES ${loopbench_python_files} DESTINATION ${loopbench_wheel}/data/share/loopbench/python/loopbench
  COMPONENT wheel EXCLUDE_FROM_ALL)
install(DIRECTORY configs DESTINATION ${loopbench_wheel}/data/share/loopbench COMPONENT wheel EXCLUDE_FROM_ALL)
install(TARGETS loopbench RUNTIME DESTINATION ${loopbench_wheel}/scripts COMPONENT wheel EXCLUDE_FROM_ALL)
# The package in the build folder links to the Python files; the compiled module is beside them.
set(loopbench_package ${PROJECT_BINARY_DIR}/python/loopbench)
file(MAKE_DIRECTORY ${loopbench_package})
foreach(file IN LISTS loopbench_python_files)
  get_filename_component(name ${file} NAME)
  file(CREATE_LINK ${file} ${loopbench_package}/${name} SYMBOLIC)
endforeach()
if(NOT LOOPBENCH_PYTHON)
  return()
endif()
# Debian's interpreter has Debian's numpy; another one can be first in PATH.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python QUIET COMPONENTS Interpreter Development.Module NumPy)
if(Python_FOUND)
  find_package(pybind11 2.10 CONFIG QUIET)
endif()
if(NOT Python_FOUND OR NOT pybind11_FOUND)
  message(STATUS "python3-dev, python3-numpy or pybind11-dev was not found: building without the Python module")
  return()
endif()
pybind11_add_module(loopbench_python MODULE NO_EXTRAS
  harness/python/module.cpp harness/python/problems.cpp harness/python/arrays.cpp)
target_link_libraries(loopbench_python PRIVATE loopbench_warnings loopbench::commands)
set_target_properties(loopbench_python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${loopbench_package})
install(TARGETS loopbench_python DESTINATION ${loopbench_site} COMPONENT python)
install(TARGETS loopbench_python DESTINATION loopbench COMPONENT wheel EXCLUDE_FROM_ALL)
