/// Times that programs state about themselves, and their mark in every output.
#pragma once

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// Follows the number or the name of the method.
inline constexpr const char* kStatedMark = " (s)";

/// Explains the mark.
inline constexpr const char* kStatedNote =
    "(s): as the program states it, without its start; `report` has the wall time, too";
inline constexpr const char* kStatedInPaper = "(s): as the program states it, without its start";

/// Whether the value of a record is a time that a program states.
inline bool is_stated(const Record& record) {
  const std::string& metric = record.kind->metric;
  return (metric == "time" || metric == "wall_ms") && record.cell->is_stated();
}

}  // namespace loopbench::harness
