# Optional libraries: without those for compressed files and bags, files that need them are rejected with exit code 4.
# Used in datasets/compressed only. GeographicLib is optional in the same way, for latitudes and longitudes: used in
# datasets/formats/geodetic.cpp only.
add_library(loopbench_compression INTERFACE)
set(loopbench_compression_flags "")  # of loopbench.pc
foreach(part "COMPRESSION z zlib.h bz2 bzlib.h zstd zstd.h lz4 lz4frame.h lzma lzma.h"
        "GEOGRAPHICLIB GeographicLib GeographicLib/LocalCartesian.hpp")
  separate_arguments(part)
  list(POP_FRONT part name)
  set(libraries "")
  set(includes "")
  set(flags "")
  while(part)
    list(POP_FRONT part library header)
    find_library(LOOPBENCH_${library} ${library})
    find_path(LOOPBENCH_${library}_INCLUDE ${header})
    list(APPEND libraries ${LOOPBENCH_${library}})
    list(APPEND includes ${LOOPBENCH_${library}_INCLUDE})
    string(APPEND flags " -l${library}")
  endwhile()
  if("${libraries};${includes}" MATCHES "NOTFOUND")
    message(STATUS "One of${flags} was not found: building without")
  else()
    target_link_libraries(loopbench_compression INTERFACE ${libraries})
    target_include_directories(loopbench_compression SYSTEM INTERFACE ${includes})
    target_compile_definitions(loopbench_compression INTERFACE LOOPBENCH_HAS_${name})
    string(APPEND loopbench_compression_flags "${flags}")
  endif()
endforeach()
