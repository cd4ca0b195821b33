/// Checks of the input data: matched poses, tracking gaps, repeated pairs, rotation, alignment.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

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

/// Tracking gaps are found only if the context has the complete estimate and reference. O(n + m).
Diagnostics diagnose(const Evaluation& evaluation, const DiagnosticsOptions& options);

/// Each value of Diagnostics as a single score; shares in %, flags as 0 or 1.
std::vector<Score> diagnostics(const Evaluation& evaluation, const DiagnosticsOptions& options);

}  // namespace loopbench::metrics
