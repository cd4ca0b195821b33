/// Google Benchmark with the option `--markdown=FILE`: a table of CPU time per pose over size, with
/// the fitted exponent of each row and the machine.
#pragma once

namespace loopbench::test {

/// Runs the registered benchmarks; returns the exit code of main.
int run_benchmarks(int argc, char** argv);

}  // namespace loopbench::test
