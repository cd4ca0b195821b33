/// Provenance of results: identification of this program's build and of the machine.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "harness/sweep/run/source.hpp"

namespace loopbench::harness {

/// Version of CMake's project().
inline constexpr const char* kVersion = LOOPBENCH_VERSION;

/// Version, compiler, flags, versions of the libraries it was built with, by name.
std::vector<std::pair<std::string, std::string>> build_metadata();

/// Hash of `code` (Source::code), of build_metadata(), of the names of the program's shared
/// libraries (which contain their versions) and of the C library's version: it differs for every
/// build that could give other results, and not for changes of commands, tables or reports.
std::string build_id(const std::string& code);

/// "loopbench 1.0.0 (a9736e1dc55d, dirty), GNU 12.2.0, -O3 -DNDEBUG; AMD EPYC, Linux 6.1 x86_64".
/// From a store's provenance; values that differ between its cells are separated by slashes.
std::string build_summary(const std::map<std::string, std::string>& provenance);

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
