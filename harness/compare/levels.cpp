#include "harness/compare/levels.hpp"

#include <algorithm>
#include <cmath>

#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {

double zero_floor(double largest) { return std::clamp(1e-9 * largest, 1e-12, 1e-9); }

Levels::Levels(const GroupedValues& all, double relevant)
    : values_(all.values),
      costs_(all.values),
      sign_(all.better == metrics::Better::higher ? -1.0 : 1.0),
      relevant_(relevant) {
  for (auto& row : costs_) {
    for (std::size_t run = 0; run < row.size(); ++run) {
      if (!row[run]) continue;
      if (all.better == metrics::Better::target) *row[run] = std::abs(*row[run] - all.target);
      is_ratio_ = is_ratio_ && *row[run] >= 0.0;
    }
  }
  for (const auto& row : costs_) {
    std::vector<double>& own = levels_.emplace_back(row.size(), 0.0);
    for (std::size_t run = 0; run < row.size(); ++run) {
      if (!row[run]) continue;
      own[run] = sign_ * (is_ratio_ ? std::log(std::max(*row[run], zero_floor(0.0))) : *row[run]);
    }
  }
  for (std::size_t run = 0; run < all.group.size(); ++run) {
    if (all.group[run] >= runs_of_.size()) runs_of_.resize(all.group[run] + 1);
    runs_of_[all.group[run]].push_back(run);
  }
}

double Levels::difference(std::size_t a, std::size_t b, std::size_t run) const {
  const double of_a = *costs_[a][run];
  const double of_b = *costs_[b][run];
  if (tied(*values_[a][run], *values_[b][run], relevant_)) return 0.0;
  if (tied(of_a, of_b, relevant_)) return 0.0;
  const double floor = zero_floor(std::max(std::abs(of_a), std::abs(of_b)));
  const bool a_zero = std::abs(of_a) <= floor;
  const bool b_zero = std::abs(of_b) <= floor;
  if (a_zero && b_zero) return 0.0;
  if (is_ratio_ && a_zero != b_zero) return sign_ * (a_zero ? -kBeyond : kBeyond);
  return level(a, run) - level(b, run);
}

double Levels::level_of_failure(std::size_t run) const {
  double best = kBeyond;
  double worst = -kBeyond;
  for (std::size_t m = 0; m < methods(); ++m) {
    if (!has(m, run)) continue;
    best = std::min(best, level(m, run));
    worst = std::max(worst, level(m, run));
  }
  return worst + (is_ratio_ ? std::log(2.0) : worst - best);
}

double Levels::standing(std::size_t method) const {
  double sum = 0.0;
  for (const std::vector<std::size_t>& runs : runs_of_) {
    double of_group = 0.0;
    for (const std::size_t run : runs) {
      of_group += has(method, run) ? level(method, run) : level_of_failure(run);
    }
    sum += of_group / static_cast<double>(runs.size());
  }
  return sum / static_cast<double>(groups());
}

}  // namespace loopbench::harness
