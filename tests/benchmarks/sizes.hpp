/// Google Benchmark with several sizes of the same work; markdown.py makes a table of its JSON.
#pragma once

#include <benchmark/benchmark.h>

#include <fstream>
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
inline void register_sizes(const std::string& name,
                           std::int64_t most,
                           const std::function<void(std::size_t, benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [run](benchmark::State& state) {
                                 run(static_cast<std::size_t>(state.range(0)), state);
                                 state.SetComplexityN(state.range(0));
                               })
      ->RangeMultiplier(10)
      ->Range(1'000, most)
      ->MeasureProcessCPUTime()
      ->Unit(benchmark::kMillisecond)
      ->Complexity();
}

inline std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

/// Runs the registered benchmarks; returns the exit code of main.
inline int run_benchmarks(int argc, char** argv) {
  benchmark::AddCustomContext("processor", processor());
  benchmark::AddCustomContext("compiler", LOOPBENCH_COMPILER);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace loopbench::test
