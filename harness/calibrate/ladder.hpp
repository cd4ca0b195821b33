/// The ladder const, time, distance, rotation, speed, drift: fitted, and judged on what was held
/// out.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/calibrate/rates.hpp"

namespace loopbench {

struct RateInterval {
  double low = 0.0;
  double high = 0.0;
};

/// One rung: a method of the catalogue and the values of its options.
struct Rung {
  std::string method;  ///< "motion_drift_time"
  Rates rates[2];      ///< by Half
  /// Log likelihood per error of sequences left out one by one; empty with only one sequence.
  std::optional<double> held_out[2];
};

/// Every rung, fitted to all sequences. O(sequences^2 edges).
std::vector<Rung> climb(const std::vector<Residuals>& sequences);

/// Option names of motion_drift and their values: noise as variances, drift as the rates' standard
/// deviations. Terms of no worth at all are told as 0, which switches them off.
std::vector<std::pair<std::string, double>> options_of(const Rung& rung);

/// 90 % intervals of options_of(), from `draws` refits to segments of `segment` edges drawn with
/// replacement within each sequence. The same seed, the same bits. A sequence's drift is one draw
/// whatever its length, so drift intervals tell of the edges, not of other sequences.
std::vector<RateInterval> bootstrap(const Rung& rung,
                                    const std::vector<Residuals>& sequences,
                                    std::size_t segment,
                                    int draws,
                                    std::uint64_t seed);

/// Root mean square of the errors of one half over all axes. [m], [rad]
double root_mean_square(Half half, const std::vector<Residuals>& sequences);

/// Pearson correlation over all edges; NaN when one of them never changes.
double correlation(Growth a, Growth b, const std::vector<Residuals>& sequences);

}  // namespace loopbench
