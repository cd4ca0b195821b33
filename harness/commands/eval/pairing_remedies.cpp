#include "harness/commands/eval/pairing_remedies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "metrics/numerics/median.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::harness {
namespace {

using metrics::Association;

std::size_t pairs_of(const Trajectory& reference,
                     const Trajectory& estimate,
                     const metrics::Protocol& rules) {
  try {
    return metrics::associate(reference, estimate, rules).reference.size();
  } catch (const std::runtime_error&) {
    return 0;
  }
}

double usual_interval(const Trajectory& poses) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    intervals.push_back(poses[i].stamp - poses[i - 1].stamp);
  }
  return intervals.empty() ? 0.0 : metrics::median(intervals);
}

/// The least difference, with two digits, that pairs as many poses as half of the longer interval.
double sufficient_difference(const Trajectory& reference,
                             const Trajectory& estimate,
                             metrics::Protocol rules) {
  rules.max_diff = 0.5 * std::max(usual_interval(reference), usual_interval(estimate));
  const metrics::Paired paired = metrics::associate(reference, estimate, rules);
  double largest = 0.0;
  for (std::size_t i = 0; i < paired.reference.size(); ++i) {
    const double stamp = paired.estimate[i].stamp + rules.offset;
    largest = std::max(largest, std::abs(stamp - paired.reference[i].stamp));
  }
  if (largest == 0.0) return 0.0;
  const double digit = std::pow(10.0, std::floor(std::log10(largest)) - 1.0);
  return std::ceil(largest / digit + 1e-3) * digit;
}

}  // namespace

std::string why_two_clocks(const EvalArguments& a,
                           const metrics::Protocol& rules,
                           const FileClock& reference,
                           const FileClock& estimate) {
  const bool is_mixed = (reference.clock == Clock::stamps) != (estimate.clock == Clock::stamps);
  if (rules.association == Association::index || (is_mixed && a.period)) return "";
  const auto is_offset = [](const GivenSetting& each) { return each.text.starts_with("offset="); };
  const std::string why = why_no_common_time(reference, estimate);
  if (why.empty() || (!is_mixed && std::ranges::any_of(a.settings, is_offset))) return "";
  if (is_mixed) return why + ", or --association index";
  return why + fmt::format(
                   ", or --offset S if only the first N rows of the estimate are missing: S = N "
                   "times {:g} s (--period)",
                   a.period.value_or(ReadOptions{}.period));
}

std::string pairing_remedies(const Trajectory& reference,
                             const Trajectory& estimate,
                             const metrics::Protocol& rules) {
  if (reference.empty() || estimate.empty()) return "";
  const std::size_t now = pairs_of(reference, estimate, rules);
  std::string out;
  metrics::Protocol changed = rules;
  const auto offer = [&](const std::string& option) {
    const std::size_t pairs = pairs_of(reference, estimate, changed);
    if (pairs > 2 && pairs >= 2 * now) out += fmt::format("; {}: {} pairs", option, pairs);
    changed = rules;
  };
  const double begin = estimate.front().stamp + rules.offset;
  const double end = estimate.back().stamp + rules.offset;
  if (end < reference.front().stamp || begin > reference.back().stamp) {
    changed.offset = reference.front().stamp - estimate.front().stamp;
    offer(fmt::format(
        "the clocks differ, and if both files begin at the same time, with --offset {:.3f}",
        changed.offset));
    return out;
  }
  if (!metrics::interpolates(rules.association) && rules.association != Association::index) {
    changed.max_diff = sufficient_difference(reference, estimate, rules);
    if (changed.max_diff > 0.0) offer(fmt::format("with --max-diff {:.3g}", changed.max_diff));
  }
  const bool is_sparse = usual_interval(reference) > usual_interval(estimate);
  changed.association = is_sparse ? Association::interpolate_estimate : Association::interpolate;
  if (changed.association != rules.association) {
    offer(is_sparse ? "with --association interpolate_estimate" : "with --association interpolate");
  }
  return out;
}

std::string remedies_without_pairs(const Trajectory& reference,
                                   const Trajectory& estimate,
                                   const metrics::Protocol& rules) {
  const bool has_pairs = pairs_of(reference, estimate, rules) > 0;
  return has_pairs ? "" : pairing_remedies(reference, estimate, rules);
}

}  // namespace loopbench::harness
