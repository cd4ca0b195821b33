/// The source of the program.
#pragma once

#include <string>

namespace loopbench::harness {

/// The source that the program was built from, as compiled into the executable.
struct Source {
  std::string commit = "unknown";
  std::string state = "unknown";  ///< clean | dirty | unknown
  std::string code = "unknown";   ///< hash of the libraries whose code decides the results of cells
};

}  // namespace loopbench::harness
