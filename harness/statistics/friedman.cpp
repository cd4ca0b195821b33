#include "harness/statistics/friedman.hpp"

#include <stdexcept>

#include "harness/statistics/chi_square.hpp"
#include "harness/statistics/ranks.hpp"

namespace loopbench {

Friedman friedman(const std::vector<std::vector<double>>& values, double tie) {
  if (values.empty() || values[0].size() < 2) {
    throw std::invalid_argument("Friedman's test needs blocks and two treatments");
  }
  const std::size_t treatments = values[0].size();
  const auto k = static_cast<double>(treatments);
  const auto n = static_cast<double>(values.size());
  Friedman out;
  out.blocks = values.size();
  out.degrees = static_cast<int>(treatments) - 1;
  out.average_ranks.assign(treatments, 0.0);
  double squares = 0.0;  // of all ranks: what ties take away from it corrects the statistic
  for (const std::vector<double>& block : values) {
    if (block.size() != treatments) throw std::invalid_argument("a block lacks a treatment");
    const std::vector<double> ranks = midranks(block, tie);
    for (std::size_t j = 0; j < treatments; ++j) {
      out.average_ranks[j] += ranks[j] / n;
      squares += ranks[j] * ranks[j];
    }
  }
  const double middle = 0.5 * (k + 1.0);
  double between = 0.0;
  for (const double rank : out.average_ranks) between += (rank - middle) * (rank - middle);
  const double within = squares - n * k * middle * middle;
  if (within <= 0.0) return out;  // all tied everywhere
  out.chi_square = (k - 1.0) * n * n * between / within;
  out.p = chi_square_tail(out.chi_square, out.degrees);
  return out;
}

}  // namespace loopbench
