/// Result of one cell.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/record.hpp"
#include "harness/sweep/model/sequence_metadata.hpp"
#include "harness/sweep/model/status.hpp"
#include "methods/report.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

/// One metric under one protocol at one choice of times. If it is undefined, only status and why
/// are set.
struct ScoreResult {
  std::size_t protocol = 0;  ///< index into Sweep::protocols
  metrics::Times times = metrics::Times::keyframes;
  std::string metric;  ///< catalogue name
  std::string label;   ///< label in the config
  metrics::Score score;
  metrics::Coverage coverage;
  Status status = Status::ok;
  std::string why;
};

inline ScoreKind kind_of(const ScoreResult& of, const Sweep& sweep) {
  const metrics::NamedProtocol& protocol = sweep.protocols[of.protocol];
  const metrics::Score& score = of.score;
  return {.protocol = protocol.label(),
          .protocol_version = protocol.version,
          .times = to_text(of.times),
          .metric = of.metric,
          .label = of.label,
          .relation = score.relation,
          .axis = score.axis,
          .unit = score.unit,
          .better = score.better,
          .target = score.target};
}

/// Execution conditions of a cell.
struct Worker {
  bool isolated = false;  ///< in a separate worker process, whose crash does not end the sweep
  bool serial = false;    ///< no other cell of the sweep ran at the same time
  bool pinned = false;    ///< pinned to one core
  bool stated = false;    ///< the times are statements of a program
};

struct CellResult : MeasuredFacts {
  Cell cell;
  Status status = Status::ok;
  std::string why;
  std::string signal;  ///< for example "SIGSEGV"; empty unless a signal ended the worker
  Worker worker;
  std::vector<double> seconds;      ///< wall time of the method, one value per timed run
  std::vector<double> cpu_seconds;  ///< CPU time of the process in these runs; empty: unknown
  methods::Report report;           ///< of the last timed run
  std::vector<Note> notes;          ///< of its runs and their evaluation
  std::vector<ScoreResult> scores;
  bool oracle_method = false;  ///< it uses the reference, or was trained on it
  CellTrace trace;             ///< under the first protocol, dense if the sweep evaluates densely
  std::shared_ptr<const SequenceMetadata> metadata;  ///< null if its sequence could not be loaded
};

/// Standard deviation by mean; none for fewer than two values or a mean of zero.
inline std::optional<double> variation(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  if (values.size() < 2 || mean == 0.0) return std::nullopt;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / (n - 1.0)) / mean;
}

/// What the scores under the protocol and times of `row` state for each evaluated pose.
inline std::vector<PoseValues> pose_values(const CellResult& result, const ScoreResult& row) {
  std::vector<PoseValues> out;
  for (const ScoreResult& each : result.scores) {
    const metrics::Score& score = each.score;
    if (each.protocol != row.protocol || each.times != row.times || score.per_pose.empty())
      continue;
    const std::string relation = score.relation == each.label ? "" : " " + score.relation;
    const std::string axis = score.axis.empty() ? "" : " " + score.axis;
    out.push_back({each.label + relation + axis, score.unit, score.per_pose});
  }
  return out;
}

}  // namespace loopbench::harness
