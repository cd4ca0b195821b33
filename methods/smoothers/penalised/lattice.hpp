/// The least of a function on whole numbers.
#pragma once

#include <algorithm>

namespace loopbench {

/// Every `coarse`-th number from low to high, then every number around the best of them: the least
/// when the function has one valley as wide as `coarse`. A later number must be smaller by 1e-9 of
/// the value to win, so that rounding decides nothing.
template <class Score>
int least_on_lattice(int low, int high, int coarse, Score score) {
  int best = low;
  double least = score(low);
  const auto look_at = [&](int k) {
    const double value = score(k);
    if (value < least - 1e-9 * std::abs(least)) {
      least = value;
      best = k;
    }
  };
  for (int k = low + coarse; k <= high; k += coarse) look_at(k);
  const int middle = best;
  for (int k = std::max(low, middle - coarse + 1); k <= std::min(high, middle + coarse - 1); ++k) {
    if (k != middle) look_at(k);
  }
  return best;
}

}  // namespace loopbench
