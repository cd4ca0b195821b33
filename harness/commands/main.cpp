#include "harness/commands/program.hpp"

// Source of the program; defined in files that the build links only into the executable, so that a
// commit does not relink anything else.
extern char source_commit[];  ///< 40 hexadecimal digits, or "unknown"
extern char source_state[];   ///< clean | dirty | unknown
extern char code_hash[];      ///< of the libraries whose code decides the results of cells

// NOLINTNEXTLINE(bugprone-exception-escape): it throws only without memory
int main(int argc, char** argv) {
  return loopbench::harness::run_program(argc, argv, {source_commit, source_state, code_hash});
}
