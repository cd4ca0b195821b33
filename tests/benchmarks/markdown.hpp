/// Benchmarks as usual, and `--markdown=FILE`: a table of processor time per pose over size, with
/// the fitted exponent of each row and the machine it was measured on.
#pragma once

namespace loopbench::test {

/// Runs what is registered; the exit code of main.
int run_benchmarks(int argc, char** argv);

}  // namespace loopbench::test
