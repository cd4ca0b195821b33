#include "harness/compare/paired.hpp"

#include <algorithm>
#include <cmath>

#include "harness/statistics/average.hpp"

namespace loopbench::harness {

PairedMethods paired(const Levels& levels, std::size_t first, std::size_t second) {
  PairedMethods out;
  std::vector<double> both;  // differences of the runs of a group
  for (std::size_t group = 0; group < levels.groups(); ++group) {
    both.clear();
    int lead = 0;  // runs with a value of only the first, minus those of only the second
    bool is_empty = true;
    for (const std::size_t run : levels.runs_of(group)) {
      const bool has_first = levels.has(first, run);
      const bool has_second = levels.has(second, run);
      lead += static_cast<int>(has_first) - static_cast<int>(has_second);
      is_empty = is_empty && !has_first && !has_second;
      if (has_first && has_second) both.push_back(levels.difference(first, second, run));
    }
    if (is_empty) continue;
    const double middle = both.empty() ? 0.0 : mean(both);
    const double value = lead != 0 ? (lead > 0 ? -kBeyond : kBeyond) : middle;
    // A zero error exceeds any finite ratio in the same group.
    const bool is_beyond = std::abs(value) > 1e-6 * kBeyond;
    out.losses_last.push_back(is_beyond ? std::copysign(kBeyond, value) : value);
    ++(value < 0.0 ? out.wins : value > 0.0 ? out.losses : out.ties);
    if (both.empty()) continue;
    out.common.push_back(middle);
    out.has_zero = out.has_zero || std::abs(middle) > 1e-6 * kBeyond;
  }
  if (out.has_zero) out.common.clear();
  return out;
}

std::optional<double> mean_difference(const PairedMethods& pair) {
  if (pair.common.empty()) return std::nullopt;
  return mean(pair.common);
}

}  // namespace loopbench::harness
