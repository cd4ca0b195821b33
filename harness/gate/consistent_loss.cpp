#include "harness/gate/consistent_loss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/statistics/differences.hpp"
#include "harness/statistics/ranks.hpp"

namespace loopbench::harness {
namespace {

/// A change below this share of the absolute limit is a rounding error.
constexpr double kSmallestChange = 1e-3;

std::string gate_group(const GateCell& cell) {
  if (!cell.group.empty()) return "group " + cell.group;
  if (!cell.content.empty()) return "content " + cell.content;
  return "run " + sequence_name(cell);
}

std::size_t needed_runs(double level) {
  std::size_t out = 1;
  while (out < 1000 && least_sign_flip_p(out) >= level) ++out;
  return out;
}

double mean_move(const RunDifferences& differences) {
  double sum = 0.0;
  for (const auto& [run, difference] : differences) sum += difference;
  return sum / static_cast<double>(differences.size());
}

}  // namespace

void ConsistentLosses::add(const GateCell& cell,
                           const GateScore& score,
                           const std::string& statistic,
                           const Tolerance& limit,
                           double before,
                           double now) {
  if (!limit.alpha || score.better == metrics::Better::neither) return;
  if (!std::isfinite(before) || !std::isfinite(now)) return;  // already reported as a regression
  const std::size_t group = groups_.try_emplace(gate_group(cell), groups_.size()).first->second;
  Series& series = series_[{cell.method, name(score), statistic}];
  if (!cell.content.empty() && std::ranges::count(series.contents, cell.content) > 0) return;
  const bool is_tie =
      tied(before, now, limit.tie) || std::abs(now - before) <= kSmallestChange * limit.absolute;
  if (score.better == metrics::Better::target) {
    before = std::abs(before - score.target);
    now = std::abs(now - score.target);
  }
  series.groups.push_back(group);
  series.contents.push_back(cell.content);
  series.before.push_back(before);
  series.now.push_back(is_tie ? before : now);
  series.better = score.better;
  series.limit = limit;
}

ConsistentLosses::Moves ConsistentLosses::moves(const Series& series) {
  const Differences differences = paired_differences(series.now, series.before, 0.0);
  std::map<std::size_t, std::pair<double, std::size_t>> sums;
  for (std::size_t i = 0; i < differences.values.size(); ++i) {
    auto& [sum, count] = sums[series.groups[i]];
    sum +=
        series.better == metrics::Better::higher ? -differences.values[i] : differences.values[i];
    ++count;
  }
  Moves out;
  out.is_ratio = differences.is_ratio;
  for (const auto& [group, sum] : sums) {
    out.by_group.emplace_back(group, sum.first / static_cast<double>(sum.second));
  }
  return out;
}

std::string ConsistentLosses::text(const ScoreKey& key,
                                   const Series& series,
                                   double p,
                                   std::size_t others) const {
  const Moves found = moves(series);
  const std::size_t runs = series.now.size();
  const std::size_t groups = found.by_group.size();
  const double middle = std::abs(mean_move(found.by_group));
  return fmt::format("{} worse over {} runs{}, by {:.3g}{} on average: p = {:.2g}{}",
                     key.statistic,
                     runs,
                     groups == runs ? "" : fmt::format(" in {} independent groups", groups),
                     found.is_ratio ? 100.0 * std::expm1(middle) : middle,
                     found.is_ratio ? " %" : "",
                     p,
                     others == 0 ? "" : fmt::format("; likewise {} more of its scores", others));
}

std::vector<Finding> ConsistentLosses::findings() const {
  std::vector<RunDifferences> comparisons;
  double level = 1.0;
  for (const auto& [key, series] : series_) {
    comparisons.push_back(moves(series).by_group);
    level = std::min(level, *series.limit.alpha);
  }
  const std::vector<double> p = sign_flip_test(comparisons, groups_.size(), level);
  struct Loss {
    const ScoreKey* key;
    const Series* series;
    double p;
    std::size_t others;
  };
  std::map<std::string, Loss> losses;  // by method, in its most significant score
  std::size_t i = 0;
  for (const auto& [key, series] : series_) {
    const double own = p[i++];
    if (own >= *series.limit.alpha) continue;
    const auto [found, is_new] = losses.try_emplace(key.method, Loss{&key, &series, own, 0});
    if (is_new) continue;
    Loss& loss = found->second;
    const std::size_t others = loss.others + 1;
    if (own < loss.p) loss = {&key, &series, own, 0};
    loss.others = others;
  }
  std::vector<Finding> out;
  for (const auto& [method, loss] : losses) {
    out.push_back({Finding::Kind::regression,
                   method,
                   loss.key->score,
                   text(*loss.key, *loss.series, loss.p, loss.others)});
  }
  return out;
}

std::vector<std::string> ConsistentLosses::notes() const {
  std::map<std::string, std::pair<std::size_t, double>> most;  // by method: groups, level
  for (const auto& [key, series] : series_) {
    const std::set<std::size_t> groups(series.groups.begin(), series.groups.end());
    auto& [count, level] = most.try_emplace(key.method, 0, 0.0).first->second;
    count = std::max(count, groups.size());
    level = std::max(level, *series.limit.alpha);
  }
  std::map<std::pair<std::size_t, double>, std::vector<std::string>> few;
  for (const auto& [method, reach] : most) {
    if (least_sign_flip_p(reach.first) >= reach.second) few[reach].push_back(method);
  }
  std::vector<std::string> out;
  for (const auto& [reach, methods] : few) {
    const auto& [count, level] = reach;
    out.push_back(fmt::format(
        "no test for small consistent losses of {}: {} independent {} reach at best p = {:.2g}, "
        "level {} needs {}",
        methods.size() == 1 ? methods.front() : fmt::format("{} methods", methods.size()),
        count,
        count == 1 ? "run" : "runs or groups",
        least_sign_flip_p(count),
        level,
        needed_runs(level)));
  }
  return out;
}

}  // namespace loopbench::harness
