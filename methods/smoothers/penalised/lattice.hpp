/// Minimum of a function on integers.
#pragma once

#include <algorithm>

namespace loopbench::methods {

/// Evaluates every `coarse`-th integer from low to high and then every integer around the best of
/// them. Returns the minimiser if the function has a single minimum at least `coarse` wide. A later
/// value must be lower by a relative 1e-9 to win, so that rounding does not change the choice.
template <class Score>
int minimise_on_lattice(int low, int high, int coarse, Score score) {
  int best = low;
  double lowest = score(low);
  const auto evaluate = [&](int k) {
    const double value = score(k);
    if (value < lowest - 1e-9 * std::abs(lowest)) {
      lowest = value;
      best = k;
    }
  };
  for (int k = low + coarse; k <= high; k += coarse) evaluate(k);
  const int middle = best;
  for (int k = std::max(low, middle - coarse + 1); k <= std::min(high, middle + coarse - 1); ++k) {
    if (k != middle) evaluate(k);
  }
  return best;
}

}  // namespace loopbench::methods
