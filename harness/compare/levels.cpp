#include "harness/compare/levels.hpp"

#include <algorithm>
#include <cmath>

#include "harness/compare/signed_rank.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {

double zero_floor(double largest) { return std::clamp(1e-9 * largest, 1e-12, 1e-9); }

Levels::Levels(const GroupedValues& all, double tie)
    : costs_(all.values),
      sequence_(all.sequence),
      sign_(all.better == metrics::Better::higher ? -1.0 : 1.0),
      tie_(tie),
      target_(all.better == metrics::Better::target ? std::abs(all.target) : 0.0),
      is_paired_(all.is_paired) {
  for (auto& row : costs_) {
    bool is_positive = true;
    for (std::optional<double>& cost : row) {
      if (cost && all.better == metrics::Better::target) cost = std::abs(*cost - all.target);
      is_positive = is_positive && !(cost && *cost < 0.0);
    }
    is_positive_.push_back(is_positive);
  }
  for (std::size_t run = 0; run < all.group.size(); ++run) {
    if (all.group[run] >= runs_of_.size()) runs_of_.resize(all.group[run] + 1);
    runs_of_[all.group[run]].push_back(run);
  }
}

std::size_t Levels::sequence_of(std::size_t group) const {
  return sequence_.empty() ? group : sequence_[runs_of_[group].front()];
}

bool Levels::has_value(std::size_t method, std::size_t run) const {
  return is_known(method, run) && !std::isnan(*costs_[method][run]);
}

std::size_t Levels::known_groups(std::size_t method) const {
  const auto is_known_in = [&](const std::vector<std::size_t>& runs) {
    return std::ranges::any_of(runs, [&](std::size_t run) { return is_known(method, run); });
  };
  return static_cast<std::size_t>(std::ranges::count_if(runs_of_, is_known_in));
}

std::optional<double> Levels::level(std::size_t method, std::size_t group) const {
  std::vector<double> known;
  for (const std::size_t run : runs_of_[group]) {
    if (!is_known(method, run)) continue;
    const double worst = sign_ * kNoRatio;
    known.push_back(has_value(method, run) ? *costs_[method][run] : worst);
  }
  if (known.empty()) return std::nullopt;
  const double middle = metrics::median(known);
  return std::abs(middle) < 0.1 * kNoRatio ? middle : kFailed;
}

double Levels::difference(std::size_t a, std::size_t b, double of_a, double of_b) const {
  const bool a_fails = std::isnan(of_a);
  const bool b_fails = std::isnan(of_b);
  if (a_fails || b_fails) return a_fails == b_fails ? 0.0 : a_fails ? kNoRatio : -kNoRatio;
  const double largest = std::max(std::abs(of_a), std::abs(of_b));
  if (std::abs(of_a - of_b) <= tie_ * std::max(largest, target_)) return 0.0;
  const double floor = zero_floor(largest);
  const bool a_zero = std::abs(of_a) <= floor;
  const bool b_zero = std::abs(of_b) <= floor;
  if (a_zero && b_zero) return 0.0;
  if (!is_ratio(a, b)) return sign_ * (of_a - of_b);
  if (a_zero != b_zero) return sign_ * (a_zero ? -kNoRatio : kNoRatio);
  return sign_ * (std::log(of_a) - std::log(of_b));
}

bool Levels::are_equal(std::size_t a, std::size_t b) const {
  for (std::size_t run = 0; run < costs_[a].size(); ++run) {
    if (is_known(a, run) != is_known(b, run) || has_value(a, run) != has_value(b, run))
      return false;
    if (has_value(a, run) && difference(a, b, run) != 0.0) return false;
  }
  return true;
}

}  // namespace loopbench::harness
