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

/// Environment variable set by `run --pin-instructions`.
inline constexpr const char* kPinnedVariable = "LOOPBENCH_PINNED_INSTRUCTIONS";

/// Extensions by which libraries choose code paths, on which last digits of results can depend:
/// "sse4_2 avx avx2 fma avx512f"; "pinned" if kPinnedVariable is set, "unknown" without
/// /proc/cpuinfo.
std::string instruction_set();

/// Restarts the program with settings that make the C library and OpenCV use the code paths of the
/// oldest supported processors (without AVX, AVX2, FMA and AVX-512), unless it was started so.
/// Eigen's paths are fixed when the program is built. Throws InputError if the restart fails.
void pin_instructions();

}  // namespace loopbench::harness
