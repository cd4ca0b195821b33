/// A baseline for the gate, constructed by hand: one score of two methods on eight repeats.
#pragma once

#include <functional>

#include "harness/compare/gate.hpp"

namespace loopbench::gate_snapshot {

using namespace methods;
using namespace metrics;
using namespace harness;

inline GateScore ate(double rmse) {
  GateScore out;
  out.protocol = "loopbench";
  out.times = "dense";
  out.metric = "ate";
  out.relation = "translation";
  out.axis = "3d";
  out.unit = "m";
  out.pairs = out.possible = out.count = 400;
  out.values = {{"rmse", rmse}};
  return out;
}

inline GateCell cell(int repeat, const std::string& method, double rmse) {
  GateCell out;
  out.sequence = "room";
  out.repeat = repeat;
  out.method = method;
  out.scores = {ate(rmse)};
  out.scores[0].sequence = out.sequence;
  out.scores[0].repeat = out.repeat;
  out.scores[0].method = out.method;
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
    out.cells.push_back(cell(repeat, "raw", error));
    out.cells.push_back(cell(repeat, "uniform", 0.5 * error));
  }
  return out;
}

inline Baseline baseline() { return {{{"compiler", "g++ 12.2"}}, {rmse_alone()}, sweep()}; }

inline GateReport after(const std::function<void(Snapshot&)>& change) {
  Snapshot now = sweep();
  change(now);
  return check(baseline(), now);
}

inline double& rmse(Snapshot& of, std::size_t cell) {
  return of.cells[cell].scores[0].values["rmse"];
}

}  // namespace loopbench::gate_snapshot
