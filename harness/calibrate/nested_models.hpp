/// Nested noise models const, time, distance, rotation, speed, drift: fitted, and evaluated on
/// held-out sequences.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/calibrate/rates.hpp"

namespace loopbench::harness {

struct RateInterval {
  double low = 0.0;
  double high = 0.0;
};

/// One nested model: a method of the catalogue and the values of its options.
struct NestedModel {
  std::string method;  ///< "motion_drift_time"
  Rates rates[2];      ///< translation, rotation
  /// Log likelihood per error in leave-one-sequence-out validation; empty with only one sequence.
  std::optional<double> held_out[2];
};

/// Fits every model to all sequences. O(sequences^2 edges).
std::vector<NestedModel> fit_nested_models(const std::vector<CalibrationResiduals>& sequences);

/// Option names of motion_drift with values: noise as variances, drift as standard deviations of
/// the rates. Negligible terms are 0, which disables them.
std::vector<std::pair<std::string, double>> options_of(const NestedModel& model);

/// 90 % bootstrap intervals of options_of(), from `draws` refits to blocks of `segment` edges drawn
/// with replacement within each sequence. Reproducible for a given seed. The drift of a sequence is
/// a single draw for any length, so drift intervals cover the edges, not other sequences.
std::vector<RateInterval> bootstrap(const NestedModel& model,
                                    const std::vector<CalibrationResiduals>& sequences,
                                    std::size_t segment,
                                    int draws,
                                    std::uint64_t seed);

/// Root mean square of the translation or rotation errors over all axes. [m], [rad]
double root_mean_square(methods::Component component,
                        const std::vector<CalibrationResiduals>& sequences);

/// Pearson correlation over all edges; NaN if one of them is constant.
double correlation(methods::Regressor a,
                   methods::Regressor b,
                   const std::vector<CalibrationResiduals>& sequences);

}  // namespace loopbench::harness
