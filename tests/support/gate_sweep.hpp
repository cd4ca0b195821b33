/// A sweep for the gate: two methods on eight repeats, with records as read from a store.
#pragma once

#include <functional>

#include "harness/compare/gate.hpp"

namespace loopbench::gate_sweep {

using namespace methods;
using namespace metrics;
using namespace harness;

inline Record score(int run, const std::string& method, const std::string& metric, double rmse) {
  Record out;
  out.cell = 2 * run + (method == "raw" ? 0 : 1);
  out.sequence = "room";
  out.repeat = run;
  out.method = method;
  out.protocol = "loopbench";
  out.times = "dense";
  out.metric = out.label = metric;
  out.relation = "translation";
  out.axis = "3d";
  out.unit = "m";
  out.statistics.rmse = rmse;
  out.statistics.max = 2.0 * rmse;
  out.statistics.count = 400;
  out.pairs = out.possible = 400;
  return out;
}

/// ATE 1.0, 1.1, ... for raw and half of it for uniform; the RPE is a tenth of the ATE.
inline std::vector<Record> records() {
  std::vector<Record> out;
  for (int run = 0; run < 8; ++run) {
    const double error = 1.0 + 0.1 * run;
    for (const auto& [method, share] : {std::pair{"raw", 1.0}, std::pair{"uniform", 0.5}}) {
      out.push_back(score(run, method, "ate", share * error));
      out.push_back(score(run, method, "rpe", 0.1 * share * error));
    }
  }
  return out;
}

/// The definitions for the records.
inline Snapshot snapshot_of(const std::vector<Record>& records,
                            const std::vector<Tolerance>& limits = {Tolerance{}}) {
  Snapshot out;
  out.sweep = "quick";
  out.machine = "GNU 12.2.0, one CPU";
  out.sequences = {{"room", "simulated: path=room, seed=1; a.txt 3 beef"}};
  out.protocols = {{"loopbench [2]", "align=se3, max_diff=0.02"}};
  out.metrics = {{"ate", "ate"}, {"rpe", "rpe, delta=1.0, unit=frames"}};
  out.methods = {{"raw", "raw"}, {"uniform", "uniform, rotation=slerp, weights=time"}};
  out.cells = gate_cells(records, limits);
  return out;
}

inline Baseline baseline() {
  return {{{"compiler", "GNU 12.2.0"}, {"source", "clean"}}, {Tolerance{}}, snapshot_of(records())};
}

}  // namespace loopbench::gate_sweep
