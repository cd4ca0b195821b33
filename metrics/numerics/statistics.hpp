/// Summaries of a list of errors, as evo, TUM and rpg define them.
#pragma once

#include <cstddef>
#include <vector>

namespace loopbench {

/// All in the unit of the errors, but count. For signed errors (axes), take magnitudes first.
struct Statistics {
  std::size_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  ///< mean of the middle two for an even count
  double std = 0.0;     ///< divides by count - ddof; 0 when that is not positive
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;  ///< sum of squares
};

/// Throws std::invalid_argument on an empty list (no statistic of nothing is honest) and
/// std::runtime_error when the sum of squares is not finite. Pairwise sums, O(n).
Statistics statistics(std::vector<double> errors, int ddof = 0);

}  // namespace loopbench
