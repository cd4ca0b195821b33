/// Scores of a replay: errors of each pose at its own time, jumps at closures, time of updates.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/core/replay.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/evaluation/evaluation.hpp"
#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {

/// Throws Undefined if there is no curve, or if the method was not replayed.
inline const Replay& replay_of(const Evaluation& evaluation) {
  const Replay* replay = needed(evaluation.context.curve, "a replay").replay();
  if (replay != nullptr) return *replay;
  throw Undefined("the method was not replayed; put `online +` in front of it");
}

/// Updates in which closures arrived or were withdrawn. Throws Undefined if there are none.
inline std::vector<ReplayUpdate> closure_updates(const Evaluation& evaluation) {
  std::vector<ReplayUpdate> out;
  for (const ReplayUpdate& update : replay_of(evaluation).updates) {
    if (update.closures > 0) out.push_back(update);
  }
  if (out.empty()) throw Undefined("no closure arrived in the replay");
  return out;
}

/// The causal trajectory of a replay (replay.hpp), keyframe k with the data that had arrived at its
/// time, including closures that arrived with it; paired and aligned by the rules of the protocol
/// like any other estimate, with an alignment of its own. The replay must outlive the result.
/// Throws Undefined if the method was not replayed. O(n log n).
inline Evaluation causal_evaluation(const Evaluation& evaluation) {
  const Replay& replay = replay_of(evaluation);
  const Trajectory& reference = needed(evaluation.context.reference, "a reference");
  Evaluation out = evaluate(reference, replay.causal, evaluation.protocol);
  out.context = {.reference = &reference,
                 .estimate = &replay.causal,
                 .problem = evaluation.context.problem,
                 .times = Times::keyframes,
                 .protocol = evaluation.protocol};
  return out;
}

/// Scores of ate() and rpe() for the causal trajectory. Throws as causal_evaluation().
inline std::vector<Score> causal_ate(const Evaluation& evaluation) {
  return ate(causal_evaluation(evaluation));
}

inline std::vector<Score> causal_rpe(const Evaluation& evaluation, const RpeOptions& options) {
  return rpe(causal_evaluation(evaluation), options);
}

/// Distance [m], scaled by the alignment, and rotation angle [deg] between the pose of the current
/// keyframe before and after each update with closures. `rmse` is the root mean square over these
/// updates, `max` the largest jump. Needs no reference. Throws Undefined if the method was not
/// replayed or no closure arrived. O(updates).
inline std::vector<Score> closure_jumps(const Evaluation& evaluation, const NoOptions& = {}) {
  std::vector<double> metres;
  std::vector<double> degrees;
  for (const ReplayUpdate& update : closure_updates(evaluation)) {
    metres.push_back(evaluation.alignment.scale *
                     (update.after.translation - update.before.translation).norm());
    degrees.push_back(kDegrees *
                      log_angle(update.before.rotation.conjugate() * update.after.rotation));
  }
  const int ddof = evaluation.protocol.ddof;
  return {{"translation", "3d", "m", statistics(std::move(metres), ddof)},
          {"rotation", "3d", "deg", statistics(std::move(degrees), ddof)}};
}

struct UpdateTimeOptions {
  double rate = 10.0;
};

template <class Visit>
void fields(UpdateTimeOptions& o, Visit visit) {
  visit("rate",
        o.rate,
        "rate of updates: one that takes longer than 1 / rate misses its deadline [Hz]",
        GreaterThan{0.0});
}

inline constexpr double kResolution = 1e-9;  // of the clock [s]

/// Exponent of the growth, or the reason why there is none.
inline Score growth_of_times(const std::vector<ReplayUpdate>& updates) {
  Score out{"growth", "", "1", {}};
  const std::size_t first = updates.front().keyframes;
  const std::size_t last = updates.back().keyframes;
  if (updates.size() < 3 || last < 2 * first) {
    out.why_undefined = "growth needs three updates over a doubled number of keyframes";
    return out;
  }
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
  const auto count = static_cast<double>(updates.size());
  const auto x_of = [](const ReplayUpdate& u) {
    return std::log(static_cast<double>(u.keyframes));
  };
  const auto y_of = [](const ReplayUpdate& u) {
    return std::log(std::max(kResolution, u.seconds));
  };
  for (const ReplayUpdate& update : updates) {
    mean_x += x_of(update) / count;
    mean_y += y_of(update) / count;
  }
  for (const ReplayUpdate& update : updates) {
    const double x = x_of(update) - mean_x;
    xx += x * x;
    xy += x * (y_of(update) - mean_y);
  }
  return single("growth", "", "1", xy / xx);
}

/// Of the wall times of all updates: `percentile` median, p95, p99 and max [s]; `misses` [%], the
/// share of updates longer than 1 / rate; `growth` [1], the exponent k of the least-squares fit
/// time ~ keyframes^k in logarithms. `growth` is undefined for fewer than three updates, or if the
/// number of keyframes does not at least double. These are measured times: they differ between
/// runs. Needs no reference. Throws Undefined if the method was not replayed or had no update.
/// O(updates log updates).
inline std::vector<Score> update_time(const Evaluation& evaluation,
                                      const UpdateTimeOptions& options) {
  const std::vector<ReplayUpdate>& updates = replay_of(evaluation).updates;
  if (updates.empty()) throw Undefined("the replay had no update");
  std::vector<double> sorted;
  for (const ReplayUpdate& update : updates) sorted.push_back(update.seconds);
  std::ranges::sort(sorted);
  const auto misses = static_cast<double>(
      std::ranges::count_if(sorted, [&](double seconds) { return seconds > 1.0 / options.rate; }));
  std::vector<Score> out;
  for (const auto& [name, share] :
       {std::pair{"median", 0.5}, {"p95", 0.95}, {"p99", 0.99}, {"max", 1.0}}) {
    out.push_back(single("percentile", name, "s", percentile(sorted, share)));
  }
  out.push_back(single("misses", "", "%", 100.0 * misses / static_cast<double>(sorted.size())));
  out.push_back(growth_of_times(updates));
  for (Score& score : out) {
    if (score.why_undefined.empty()) score.statistics.count = sorted.size();
  }
  return out;
}

}  // namespace loopbench::metrics
