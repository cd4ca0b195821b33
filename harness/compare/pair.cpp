#include "harness/compare/pair.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/statistics/average.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// A sequence with this many groups can estimate its own typical difference.
constexpr std::size_t kFewestOfSequence = 5;

/// Log ratio to an error of zero in means, a factor of 1e-12.
constexpr double kZeroRatio = 27.6;

bool is_finite(double value) { return std::abs(value) < 0.1 * kBeyond; }

std::vector<double> sorted(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

/// Values by sequence.
std::map<std::size_t, std::vector<double>> split(const Pair& pair) {
  std::map<std::size_t, std::vector<double>> out;
  for (std::size_t i = 0; i < pair.values.size(); ++i) {
    out[pair.sequence[i]].push_back(pair.values[i]);
  }
  for (auto& [sequence, values] : out) std::ranges::sort(values);
  return out;
}

/// Sorted values whose sequences have the same typical value, the mean of all. The deviations are
/// larger by as much as they are too small for having been measured from an estimate.
std::vector<double> aligned(const Pair& pair) {
  const auto sequences = split(pair);
  std::map<std::size_t, double> middles;
  double common = 0.0;
  for (const auto& [sequence, values] : sequences) {
    if (sequences.size() < 2 || values.size() < kFewestOfSequence) return sorted(pair.values);
    const double middle = middles[sequence] = pseudo_median(values);
    if (!is_finite(middle)) return sorted(pair.values);
    common += middle * static_cast<double>(values.size()) / static_cast<double>(pair.values.size());
  }
  std::vector<double> out;
  for (const auto& [sequence, values] : sequences) {
    const auto n = static_cast<double>(values.size());
    for (const double value : values) {
      const double deviation = (value - middles[sequence]) * std::sqrt(n / (n - 1.0));
      out.push_back(is_finite(value) ? common + deviation : value);
    }
  }
  return sorted(out);
}

/// Median of differences of which some are +-kBeyond.
double middle_of(const std::vector<double>& values) {
  const double middle = metrics::median(values);
  return is_finite(middle) ? middle : std::copysign(kBeyond, middle);
}

}  // namespace

bool Pair::is_first_ahead() const {
  if (ranks.negative != ranks.positive) return ranks.negative > ranks.positive;
  return mean && *mean < 0.0;
}

bool Pair::is_contradicted() const {
  if (!mean || *mean == 0.0 || (*mean < 0.0) == is_first_ahead()) return false;
  const double beyond = is_first_ahead() ? -kBeyond : kBeyond;  // decided without a ratio
  const auto decided = static_cast<std::size_t>(std::ranges::count(values, beyond));
  return decided <= (is_first_ahead() ? losses : wins);
}

bool Pair::is_significant(double alpha, std::size_t tests) const {
  return p() * static_cast<double>(tests) <= alpha && !is_contradicted();
}

std::optional<Interval> Pair::typical(double alpha) const {
  std::optional<Interval> out = shift_interval(aligned(*this), alpha);
  if (!out) return out;
  if (p() > alpha) {
    out->low = std::min(out->low, 0.0);
    out->high = std::max(out->high, 0.0);
  } else {  // ties and the differences between sequences can leave 0 inside
    (is_first_ahead() ? out->high : out->low) =
        is_first_ahead() ? std::min(out->high, 0.0) : std::max(out->low, 0.0);
  }
  out->estimate = std::clamp(out->estimate, out->low, out->high);
  return out;
}

std::vector<std::pair<std::size_t, double>> Pair::by_sequence() const {
  std::vector<std::pair<std::size_t, double>> out;
  for (auto& [sequence, of_sequence] : split(*this)) {
    std::vector<double> finite = of_sequence;
    std::erase_if(finite, [](double value) { return !is_finite(value); });
    if (!finite.empty()) out.emplace_back(sequence, harness::mean(finite));
  }
  return out;
}

std::optional<double> Pair::deviation() const {
  std::vector<double> finite;
  for (const double value : values) {
    if (is_finite(value)) finite.push_back(value);
  }
  const auto sequences = by_sequence();
  if (sequences.size() < 2 || 2 * sequences.size() > finite.size()) {
    return finite.size() < 2 ? std::nullopt : std::optional(sample_deviation(finite));
  }
  const std::map<std::size_t, double> means(sequences.begin(), sequences.end());
  double squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (is_finite(values[i])) squares += std::pow(values[i] - means.at(sequence[i]), 2);
  }
  return std::sqrt(squares / static_cast<double>(finite.size() - sequences.size()));
}

Pair compared(const Levels& levels, std::size_t first, std::size_t second) {
  Pair out;
  out.is_ratio = levels.is_ratio(first, second);
  std::vector<double> all;   // differences of the runs of a group
  std::vector<double> both;  // of those on which both have a value
  std::vector<double> means;
  for (std::size_t group = 0; group < levels.groups(); ++group) {
    all.clear();
    both.clear();
    for (const std::size_t run : levels.runs_of(group)) {
      if (!levels.is_known(first, run) || !levels.is_known(second, run)) continue;
      const bool has_first = levels.has_value(first, run);
      const bool has_second = levels.has_value(second, run);
      if (!has_first && !has_second) continue;
      if (has_first != has_second) {
        all.push_back(has_first ? -kBeyond : kBeyond);
        continue;
      }
      all.push_back(levels.difference(first, second, run));
      const bool is_zero = !is_finite(all.back());
      both.push_back(is_zero ? std::copysign(kZeroRatio, all.back()) : all.back());
      out.has_zero = out.has_zero || is_zero;
    }
    if (all.empty()) continue;
    const double value = middle_of(all);
    out.values.push_back(value);
    out.sequence.push_back(levels.sequence_of(group));
    ++(value < 0.0 ? out.wins : value > 0.0 ? out.losses : out.ties);
    if (!both.empty()) means.push_back(mean(both));
  }
  if (!means.empty()) out.mean = mean(means);
  out.ranks = signed_rank(out.values);
  return out;
}

}  // namespace loopbench::harness
