/// Report of a method run: time per phase, counts, notes, and sections of the trajectory.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/se3.hpp"

namespace loopbench::methods {

struct Phase {
  std::string name;
  double seconds = 0.0;
};

struct Count {
  std::string name;  ///< "iterations", "segments", "fallbacks"
  double value = 0.0;
};

/// A time interval that a method processed as one unit. Sections of the same kind may overlap.
struct Section {
  std::string kind;    ///< "segment", "window", "spatial window"
  double begin = 0.0;  ///< stamp [s]
  double end = 0.0;    ///< stamp [s]
  std::string what;    ///< model chosen there, for example "cubic"; may be empty
};

struct Report {
  std::vector<Phase> phases;
  std::vector<Count> counts;
  std::vector<std::string> notes;  ///< fallbacks taken, gaps left: one short sentence each
  std::vector<Section> sections;   ///< sorted by kind, then by time
  /// Covariance of each keyframe in fixed axes (datasets/core/covariance.hpp); empty: none stated.
  std::vector<Matrix6> covariances;
  /// Indices in Problem::closures, ascending; unset: the method does not choose among them. Read by
  /// metrics, not kept by sweeps.
  std::optional<std::vector<std::size_t>> rejected;

  void count(std::string name, double value) { counts.push_back({std::move(name), value}); }

  /// Runs `work` and adds a phase with its duration.
  template <class Work>
  auto time(std::string name, Work work) {
    const auto begin = std::chrono::steady_clock::now();
    auto result = work();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    phases.push_back({std::move(name), took.count()});
    return result;
  }
};

}  // namespace loopbench::methods
