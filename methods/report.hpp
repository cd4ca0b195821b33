/// What a method says about its own work: time by phase, counts, remarks.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace loopbench {

struct Phase {
  std::string name;
  double seconds = 0.0;
};

struct Count {
  std::string name;  ///< "iterations", "segments", "fallbacks"
  double value = 0.0;
};

struct Report {
  std::vector<Phase> phases;
  std::vector<Count> counts;
  std::vector<std::string> notes;  ///< a fallback taken, a gap left: one short sentence each

  void count(std::string name, double value) { counts.push_back({std::move(name), value}); }

  /// Runs `work` and adds a phase with the time it took.
  template <class Work>
  auto time(std::string name, Work work) {
    const auto begin = std::chrono::steady_clock::now();
    auto result = work();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    phases.push_back({std::move(name), took.count()});
    return result;
  }
};

}  // namespace loopbench
