#include "tests/benchmarks/markdown.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <string_view>
#include <thread>
#include <vector>

namespace loopbench::test {
namespace {

struct Row {
  std::string name;
  std::map<double, double> seconds;  ///< by size
};

/// Slope of log(seconds) over log(size): 1 is linear.
double exponent(const std::map<double, double>& seconds) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const auto& [size, time] : seconds) {
    const double u = std::log(size);
    const double v = std::log(time);
    n += 1.0, x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

class Table final : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      const std::string name = run.run_name.function_name;
      if (rows_.empty() || rows_.back().name != name) rows_.push_back({name, {}});
      rows_.back().seconds[static_cast<double>(run.complexity_n)] =
          run.cpu_accumulated_time / static_cast<double>(run.iterations);
    }
  }

  std::string markdown(const std::string& machine) const {
    std::string out = "Nanoseconds of processor time (all threads) per pose, by number of poses. " +
                      machine + "\n\n|";
    if (rows_.empty()) return out;
    std::string rule = "\n|---|";
    out += " |";
    for (const auto& [size, _] : rows_.front().seconds) {
      out += fmt::format(" 1e{:.0f} |", std::log10(size));
      rule += "---:|";
    }
    out += " exponent |" + rule + "---:|\n";
    for (const Row& row : rows_) {
      out += "| " + row.name + " |";
      for (const auto& [size, _] : rows_.front().seconds) {
        const auto found = row.seconds.find(size);
        out += found == row.seconds.end() ? " |"
                                          : fmt::format(" {:.1f} |", 1e9 * found->second / size);
      }
      out += row.seconds.size() < 2 ? " |\n" : fmt::format(" {:.2f} |\n", exponent(row.seconds));
    }
    return out;
  }

 private:
  std::vector<Row> rows_;
};

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

}  // namespace

void register_sizes(const std::string& name,
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

int run_benchmarks(int argc, char** argv) {
  constexpr std::string_view kFlag = "--markdown=";
  std::string file;
  std::vector<char*> rest;
  for (int i = 0; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.starts_with(kFlag)) {
      file = argument.substr(kFlag.size());
    } else {
      rest.push_back(argv[i]);
    }
  }
  const unsigned hardware_threads = std::thread::hardware_concurrency();
  benchmark::AddCustomContext("processor", processor());
  benchmark::AddCustomContext("compiler", LOOPBENCH_COMPILER);
  int count = static_cast<int>(rest.size());
  benchmark::Initialize(&count, rest.data());
  if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 1;
  Table table;
  benchmark::RunSpecifiedBenchmarks(&table);
  benchmark::Shutdown();
  if (file.empty()) return 0;
  std::ofstream out(file);
  out << table.markdown(
      fmt::format("{}, {} cores, {}.", processor(), hardware_threads, LOOPBENCH_COMPILER));
  return out.flush() ? 0 : 1;
}

}  // namespace loopbench::test
