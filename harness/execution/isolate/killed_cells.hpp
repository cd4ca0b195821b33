/// Cells that a signal from outside ended.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include "harness/model/result.hpp"

namespace loopbench::harness {

/// Decides which cells run once more. A scheduler that ends a job sends SIGTERM, later SIGKILL, to
/// all of its processes in any order, so a sweep can see a cell end before it is ended itself. That
/// is no result of the method.
class KilledCells {
 public:
  /// Whether a cell whose process or worker was ended by `signal` ("SIGKILL") runs again: the first
  /// time that a signal of a scheduler or of the system ended it.
  bool runs_again(std::size_t cell, const std::string& signal) {
    constexpr std::array<std::string_view, 4> kFromOutside{
        "SIGTERM", "SIGKILL", "SIGINT", "SIGHUP"};
    return std::ranges::count(kFromOutside, signal) > 0 && cells_.insert(cell).second;
  }

  /// Once the sweep has to stop, its request can also have ended a program that a cell runs.
  static void set_interrupted(CellResult& result) {
    if (result.status != Status::crashed && result.status != Status::failed) return;
    result.status = Status::interrupted;
  }

 private:
  std::set<std::size_t> cells_;  ///< that were run again
};

}  // namespace loopbench::harness
