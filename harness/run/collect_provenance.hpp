/// Provenance of results: build and machine.
#pragma once

#include <map>
#include <string>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// The source that the program was built from, as compiled into the executable.
struct Source {
  std::string commit = "unknown";
  std::string state = "unknown";  ///< clean | dirty | unknown
  std::string code = "unknown";   ///< hash of the libraries whose code decides the results of cells
};

/// build_metadata(), commit, state, build, C library, shared libraries, CPU, instruction set,
/// cores, memory, kernel, the seeds of every seeded dataset and the versions of plugins. Does not
/// depend on the time of the call.
std::map<std::string, std::string> provenance(const Source& source,
                                              const Sweep& sweep,
                                              const Catalogue& catalogue);

/// Extensions by which libraries choose code paths, on which last digits of results can depend:
/// "sse4_2 avx avx2 fma avx512f"; "unknown" without /proc/cpuinfo.
std::string instruction_set();

}  // namespace loopbench::harness
