/// Where and by what results were made, beside the results.
#pragma once

#include <map>
#include <string>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// The commit the program was built from, as its main file knows it.
struct Source {
  std::string commit = "unknown";
  std::string state = "unknown";  ///< clean | dirty | unknown
};

/// build_facts(), commit, state, build, C library, shared libraries, CPU, cores, memory, kernel,
/// the seeds of every seeded dataset and the versions of plugins. None of it depends on when it is
/// asked.
std::map<std::string, std::string> provenance(const Source& source,
                                              const Sweep& sweep,
                                              const Catalogue& catalogue);

}  // namespace loopbench
