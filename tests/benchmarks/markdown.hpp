/// Google Benchmark with the option `--markdown=FILE`: a table of CPU time per pose over size, with
/// the fitted exponent of each row and the machine.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace loopbench::test {

/// kMake(size), kept until another size is asked for.
template <auto kMake>
const auto& kept(std::size_t size) {
  static std::optional<std::pair<std::size_t, decltype(kMake(size))>> last;
  if (!last || last->first != size) {
    last.reset();  // one size at a time is large enough
    last.emplace(size, kMake(size));
  }
  return last->second;
}

/// Registers a benchmark of the sizes 1000, 10,000, ... `most`. It measures the processor time of
/// all threads, which is independent of other processes.
void register_sizes(const std::string& name,
                    std::int64_t most,
                    const std::function<void(std::size_t, benchmark::State&)>& run);

/// Runs the registered benchmarks; returns the exit code of main.
int run_benchmarks(int argc, char** argv);

}  // namespace loopbench::test
