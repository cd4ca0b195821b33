/// Main function of the process that supervises an external program.
#pragma once

#include "harness/external/process_tree.hpp"

namespace loopbench::harness {

/// Ends of the supervisor's pipes.
struct SupervisorFiles {
  int control = -1;  ///< closed by the other side: end the tree
  int status = -1;   ///< receives the ProgramEnd
  int input = -1;    ///< of the program; -1: none
  int output = -1;
  int errors = -1;
};

/// Called in a new child process; does not return. `environment` is the complete list NAME=VALUE.
[[noreturn]] void supervise(const ProgramStart& start,
                            const std::vector<std::string>& environment,
                            const SupervisorFiles& files);

}  // namespace loopbench::harness
