/// Friedman's test: do treatments differ at all, over blocks that each saw every treatment?
#pragma once

#include <cstddef>
#include <vector>

namespace loopbench {

struct Friedman {
  std::vector<double> average_ranks;  ///< by treatment; 1 is the smallest value
  double chi_square = 0.0;            ///< corrected for ties (Conover 1999, section 5.8)
  int degrees = 0;                    ///< of freedom: treatments - 1
  double p = 1.0;                     ///< of the chi-square distribution, close from 10 blocks on
  std::size_t blocks = 0;
};

/// `values[block][treatment]`; what is tied within a block (see ranks.hpp) shares its rank. p is 1
/// when every block ties throughout. Throws std::invalid_argument on fewer than two treatments, no
/// block, or blocks of different lengths. O(blocks * treatments * log treatments).
Friedman friedman(const std::vector<std::vector<double>>& values, double tie = 0.0);

}  // namespace loopbench
