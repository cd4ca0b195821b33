/// What a method says about its own work: time by phase, counts, remarks, how it cut up the way.
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

/// A stretch of the way that a method treated as one. Those of one kind may overlap.
struct Section {
  std::string kind;    ///< "segment", "window", "spatial window"
  double begin = 0.0;  ///< stamp [s]
  double end = 0.0;    ///< stamp [s]
  std::string what;    ///< what was chosen there, as "cubic"; may be empty
};

struct Report {
  std::vector<Phase> phases;
  std::vector<Count> counts;
  std::vector<std::string> notes;  ///< a fallback taken, a gap left: one short sentence each
  std::vector<Section> sections;   ///< in the order of their kind, then of time

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
