/// A baseline for the gate, constructed by hand: one score of two methods on eight repeats.
#pragma once

#include <functional>

#include "harness/answers/gate/gate.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::gate_snapshot {

using namespace methods;
using namespace metrics;
using namespace harness;

inline Record ate(int repeat, const std::string& method, double rmse) {
  Record out = compared_sweep::score("room", repeat, method, rmse);
  out.pairs = out.possible = 400;
  out.statistics.count = 400;
  return out;
}

inline Tolerance rmse_alone() {
  Tolerance out;
  out.values = {"rmse"};
  return out;
}

/// Two methods on eight repeats; errors 1.0, 1.1, ... and half of these.
inline Snapshot sweep() {
  Snapshot out;
  out.sweep = "quick";
  out.sequences = {{"room", "path=room"}};
  out.protocols = {{"loopbench [1]", "align=se3"}};
  for (int repeat = 0; repeat < 8; ++repeat) {
    const double error = 1.0 + 0.1 * repeat;
    out.records.push_back(ate(repeat, "raw", error));
    out.records.push_back(ate(repeat, "uniform", 0.5 * error));
  }
  return out;
}

inline Baseline baseline() { return {{{"compiler", "g++ 12.2"}}, {rmse_alone()}, sweep()}; }

/// Leaves only the status of a cell.
inline void fail(Snapshot& of, std::size_t cell, Status status) {
  of.records[cell].kind = {};
  of.records[cell].status = status;
}

inline GateReport after(const std::function<void(Snapshot&)>& change) {
  Snapshot now = sweep();
  change(now);
  return check(baseline(), now);
}

inline double& rmse(Snapshot& of, std::size_t cell) { return of.records[cell].statistics.rmse; }

}  // namespace loopbench::gate_snapshot
