/// Checks of the input data: coverage, matched poses, tracking gaps, repeated pairs, rotation,
/// alignment.
#pragma once

#include <algorithm>
#include <cmath>

#include "metrics/metric.hpp"
#include "metrics/trajectory/heading.hpp"
#include "metrics/trajectory/position_only.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::metrics {

/// Single values. In 0..1, each with count = evaluated pairs and std = 0: relation `share` (pairs
/// over possible pairs) and `span` (evaluated time, without tracking gaps, over the reference's
/// duration). `bridged` [s]: duration of tracking gaps that the curve bridges; 0 at keyframes.
inline std::vector<Score> coverage(const Evaluation& evaluation) {
  const Coverage& found = evaluation.coverage;
  const auto single = [&](const std::string& relation, double value) {
    Score score{relation, "", "1", statistics({value})};
    score.statistics.count = found.pairs;
    return score;
  };
  return descriptions({single("share", found.share()),
                       single("span", found.span),
                       metrics::single("bridged", "", "s", found.bridged)});
}

struct DiagnosticsOptions {
  double rest_speed = 0.05;
  double window = 1.0;
  double tracking_gap = 2.0;
};

template <class Visit>
void fields(DiagnosticsOptions& o, Visit visit) {
  visit(
      "rest_speed", o.rest_speed, "speed below which the reference is at rest [m/s]", Between{0.0});
  visit("window", o.window, "time window for the speed [s]", Between{0.0});
  visit("tracking_gap",
        o.tracking_gap,
        "time without poses of the estimate, while the reference moves, that counts as a tracking "
        "gap [s]",
        GreaterThan{0.0});
}

/// Values of the metric `diagnostics`.
struct Diagnostics {
  std::size_t matched = 0;
  std::size_t possible = 0;
  double longest_pair_interval = 0.0;  ///< largest time between neighbouring pairs [s]
  /// Pairs that use a pose a second time (association evo), and pairs whose estimate stamp is
  /// before that of the previous pair (association tum, around bursts). Repeated or unsorted stamps
  /// inside one file are handled by the readers, which reject them or, on request, keep one.
  std::size_t repeated = 0;
  std::size_t crossing = 0;
  double off_unit =
      0.0;       ///< largest | |q| - 1 |; readers reject values above a limit and normalise
  int rank = 3;  ///< of the alignment, see Alignment
  double condition = 1.0;
  double at_rest = 0.0;                  ///< share of pairs at which the reference is at rest, 0..1
  bool position_only_reference = false;  ///< if true, rotation is not evaluated
  bool position_only_estimate = false;
  /// Tracking gaps: pauses of the estimate longer than `tracking_gap` during which the reference
  /// moved.
  std::size_t tracking_gaps = 0;
  double tracking_gap_time = 0.0;     ///< total duration of the tracking gaps [s]
  double longest_tracking_gap = 0.0;  ///< [s]
};

inline void diagnose_pairs(const Evaluation& evaluation, Diagnostics& out) {
  const Trajectory& reference = evaluation.reference;
  const Trajectory& estimate = evaluation.estimate;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (const Trajectory* poses : {&reference, &estimate}) {
      const double norm = (*poses)[i].world_from_body.rotation.norm();
      out.off_unit = std::max(out.off_unit, std::abs(norm - 1.0));
    }
    if (i == 0) continue;
    const double gap = reference[i].stamp - reference[i - 1].stamp;
    const double ours = estimate[i].stamp - estimate[i - 1].stamp;
    out.longest_pair_interval = std::max(out.longest_pair_interval, gap);
    out.repeated += gap == 0.0 || ours == 0.0;
    out.crossing += gap < 0.0 || ours < 0.0;
  }
}

inline void diagnose_gaps(const Trajectory& reference,
                          const Trajectory& estimate,
                          double offset,
                          const DiagnosticsOptions& o,
                          Diagnostics& out) {
  for (const TrackingGap& gap :
       gaps_while_moving(reference, stamps(estimate), offset, o.tracking_gap, o.rest_speed)) {
    const double duration = gap.end - gap.begin;
    ++out.tracking_gaps;
    out.tracking_gap_time += duration;
    out.longest_tracking_gap = std::max(out.longest_tracking_gap, duration);
  }
}

/// Tracking gaps are found only if the context has the complete estimate and reference. O(n + m).
inline Diagnostics diagnose(const Evaluation& evaluation, const DiagnosticsOptions& options) {
  Diagnostics out;
  out.matched = evaluation.coverage.pairs;
  out.possible = evaluation.coverage.possible;
  out.rank = evaluation.alignment.rank;
  out.condition = evaluation.alignment.condition;
  diagnose_pairs(evaluation, out);
  const std::vector<Chord> windows = chords(evaluation.reference, options.window);
  const auto at_rest = std::ranges::count_if(
      windows, [&](const Chord& chord) { return !chord.is_moving(options.rest_speed); });
  if (!windows.empty())
    out.at_rest = static_cast<double>(at_rest) / static_cast<double>(windows.size());
  out.position_only_reference = is_position_only(evaluation.reference);
  out.position_only_estimate = is_position_only(evaluation.estimate);
  const Context& context = evaluation.context;
  if (context.reference != nullptr && context.estimate != nullptr) {
    diagnose_gaps(*context.reference, *context.estimate, context.protocol.offset, options, out);
  }
  return out;
}

/// Each value of Diagnostics as a single score; shares in %, flags as 0 or 1.
inline std::vector<Score> diagnostics(const Evaluation& evaluation,
                                      const DiagnosticsOptions& options) {
  const Diagnostics d = diagnose(evaluation, options);
  const auto count_score = [](const char* name, std::size_t count) {
    return single(name, "", "1", static_cast<double>(count));
  };
  return descriptions({count_score("matched", d.matched),
                       count_score("possible", d.possible),
                       single("longest_pair_interval", "", "s", d.longest_pair_interval),
                       count_score("repeated", d.repeated),
                       count_score("crossing", d.crossing),
                       single("off_unit", "", "1", d.off_unit),
                       single("alignment_rank", "", "1", d.rank),
                       single("alignment_condition", "", "1", d.condition),
                       single("at_rest", "", "%", 100.0 * d.at_rest),
                       count_score("position_only_reference", d.position_only_reference),
                       count_score("position_only_estimate", d.position_only_estimate),
                       count_score("tracking_gaps", d.tracking_gaps),
                       single("tracking_gap_time", "", "s", d.tracking_gap_time),
                       single("longest_tracking_gap", "", "s", d.longest_tracking_gap)});
}

}  // namespace loopbench::metrics
