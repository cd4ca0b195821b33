# Compression libraries for compressed files and bags, each optional: without one, files that need it are
# rejected with exit code 4. Used in datasets/compressed only. GeographicLib is optional in the same way, for
# latitudes and longitudes: used in datasets/formats/geodetic.cpp only.
add_library(loopbench_compression INTERFACE)
set(loopbench_compression_flags "")  # of loopbench.pc
foreach(codec "ZLIB z zlib.h" "BZIP2 bz2 bzlib.h" "ZSTD zstd zstd.h" "LZ4 lz4 lz4frame.h"
        "LZMA lzma lzma.h" "GEOGRAPHICLIB GeographicLib GeographicLib/LocalCartesian.hpp")
  separate_arguments(codec)
  list(POP_FRONT codec name library header)
  find_library(LOOPBENCH_${name} ${library})
  find_path(LOOPBENCH_${name}_INCLUDE ${header})
  if(LOOPBENCH_${name} AND LOOPBENCH_${name}_INCLUDE)
    target_link_libraries(loopbench_compression INTERFACE ${LOOPBENCH_${name}})
    target_include_directories(loopbench_compression SYSTEM INTERFACE ${LOOPBENCH_${name}_INCLUDE})
    target_compile_definitions(loopbench_compression INTERFACE LOOPBENCH_HAS_${name})
    string(APPEND loopbench_compression_flags " -l${library}")
  else()
    message(STATUS "${library} was not found: building without it")
  endif()
endforeach()
