/// Statistics of a list of errors, as defined by evo, TUM and rpg.
#pragma once

#include <cstddef>
#include <vector>

namespace loopbench::metrics {

/// All in the unit of the errors, except count. Pass magnitudes for signed errors (axes).
struct Statistics {
  std::size_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  ///< mean of the middle two for an even count
  double std = 0.0;     ///< divides by count - ddof; 0 if that is not positive
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;  ///< sum of squares
  /// Percentiles, linear between order statistics at rank (n - 1) p (numpy's default).
  double p90 = 0.0, p95 = 0.0, p99 = 0.0;
};

/// A statistic with its name in stores, tables and options.
struct StatisticField {
  const char* name;
  double Statistics::*member;
  double share = 0.0;  ///< of the errors below a percentile; 0: it is none
};

/// All but `count`, in the order of columns; the percentiles last, in ascending order. Whoever adds
/// one increments the version of stores.
inline constexpr StatisticField kStatisticFields[] = {{"rmse", &Statistics::rmse},
                                                      {"mean", &Statistics::mean},
                                                      {"median", &Statistics::median},
                                                      {"std", &Statistics::std},
                                                      {"min", &Statistics::min},
                                                      {"max", &Statistics::max},
                                                      {"sse", &Statistics::sse},
                                                      {"p90", &Statistics::p90, 0.90},
                                                      {"p95", &Statistics::p95, 0.95},
                                                      {"p99", &Statistics::p99, 0.99}};

/// Throws std::invalid_argument for an empty list and std::runtime_error if the sum of squares is
/// not finite. Pairwise summation, O(n).
Statistics statistics(std::vector<double> errors, int ddof = 0);

}  // namespace loopbench::metrics
