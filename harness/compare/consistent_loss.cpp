#include "harness/compare/consistent_loss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "harness/compare/observations.hpp"
#include "harness/compare/ranks.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::harness {
namespace {

/// A change below this share of the absolute limit is a rounding error.
constexpr double kSmallestChange = 1e-3;

constexpr std::size_t kMostExactGroups = 14;  // 16384 sign flips
constexpr std::size_t kSignFlips = 20'000;

/// The smallest p over so many groups.
double least_p_of(std::size_t groups) { return std::pow(0.5, static_cast<double>(groups)); }

/// Signed ranks of one series by group, standardised, without zeros (Pratt).
std::vector<double> signed_ranks(const std::map<std::size_t, std::vector<double>>& changes,
                                 std::size_t groups) {
  std::vector<double> means;
  std::vector<double> magnitudes;
  for (const auto& [group, of_group] : changes) {
    means.push_back(metrics::mean(of_group));
    magnitudes.push_back(std::abs(means.back()));
  }
  const std::vector<double> ranks = midranks(magnitudes);
  std::vector<double> out(groups, 0.0);
  double variance = 0.0;
  std::size_t i = 0;
  for (const auto& [group, of_group] : changes) {
    if (means[i] != 0.0) variance += ranks[i] * ranks[i];
    if (means[i] != 0.0) out[group] = std::copysign(ranks[i], means[i]);
    ++i;
  }
  for (double& rank : out) rank /= std::max(std::sqrt(variance), 1e-300);
  return out;
}

/// Sum of the ranks after a flip of the groups whose bit is set.
double flipped_sum(const std::vector<double>& ranks, const std::vector<std::uint64_t>& flips) {
  double sum = 0.0;
  for (std::size_t group = 0; group < ranks.size(); ++group) {
    const bool is_flipped = (flips[group / 64] >> (group % 64) & 1U) != 0;
    sum += is_flipped ? -ranks[group] : ranks[group];
  }
  return sum;
}

}  // namespace

void ConsistentLosses::add(const GateCell& cell,
                           const GateScore& score,
                           const std::string& statistic,
                           const Tolerance& limit,
                           double before,
                           double worse) {
  if (!limit.alpha || score.better == metrics::Better::neither) return;
  if (!std::isfinite(before) || !std::isfinite(worse)) return;  // already a regression
  Series& series = series_[{cell.method, name(score), statistic}];
  const bool is_copy = !cell.content.empty() && !series.contents.insert(cell.content).second;
  if (is_copy) return;
  const std::string group = !cell.group.empty()     ? "group " + cell.group
                            : !cell.content.empty() ? "content " + cell.content
                                                    : "run " + run_name(cell);
  const double size = std::max(std::abs(before), std::abs(worse));
  const bool is_tie =
      std::abs(worse) <= limit.tie * size || std::abs(worse) <= kSmallestChange * limit.absolute;
  const double relative = worse / (before == 0.0 ? size : std::abs(before));
  series.changes[groups_.emplace(group, groups_.size()).first->second].push_back(is_tie ? 0.0
                                                                                        : relative);
  series.alpha = *limit.alpha;
  ++series.runs;
}

std::vector<double> ConsistentLosses::p_values() const {
  std::vector<std::vector<double>> ranks;
  for (const auto& [key, series] : series_) {
    ranks.push_back(signed_ranks(series.changes, groups_.size()));
  }
  const bool is_exact = groups_.size() <= kMostExactGroups;
  const std::size_t flips = is_exact ? std::size_t{1} << groups_.size() : kSignFlips;
  std::mt19937_64 random(1);
  std::vector<std::uint64_t> bits(groups_.size() / 64 + 1, 0);
  std::vector<double> largest;
  for (std::size_t flip = 0; flip < flips; ++flip) {
    for (std::uint64_t& word : bits) word = is_exact || flip == 0 ? flip : random();
    double most = 0.0;
    for (const std::vector<double>& of_series : ranks) {
      most = std::max(most, flipped_sum(of_series, bits));
    }
    largest.push_back(most);
  }
  std::ranges::sort(largest);
  const std::vector<std::uint64_t> none(bits.size(), 0);
  std::vector<double> out;
  for (const std::vector<double>& of_series : ranks) {
    constexpr double kRounding = 1e-9;
    const double own = flipped_sum(of_series, none) - kRounding;
    const auto as_large = largest.end() - std::ranges::lower_bound(largest, own);
    out.push_back(static_cast<double>(as_large) / static_cast<double>(flips));
  }
  return out;
}

void ConsistentLosses::report(GateReport& out) const {
  struct Loss {
    Finding finding;
    double p = 1.0;
    std::size_t scores = 0;
  };
  std::map<std::string, Loss> losses;
  std::map<std::pair<std::size_t, double>, std::set<std::string>> few;  // by groups and level
  const std::vector<double> p = p_values();
  std::size_t i = 0;
  for (const auto& [key, series] : series_) {
    const auto& [method, score, statistic] = key;
    const double own = p[i++];
    const std::size_t groups = series.changes.size();
    if (least_p_of(groups) >= series.alpha) few[{groups, series.alpha}].insert(method);
    if (own >= series.alpha) continue;
    Loss& loss = losses[method];
    ++loss.scores;
    if (own >= loss.p) continue;
    std::vector<double> means;
    for (const auto& [group, of_group] : series.changes) means.push_back(metrics::mean(of_group));
    loss.p = own;
    loss.finding = {
        Finding::Kind::regression,
        method,
        score,
        fmt::format("{} worse over {} runs{}, by {:.3g} % on average: p = {:.2g}",
                    statistic,
                    series.runs,
                    groups == series.runs ? "" : fmt::format(" in {} independent groups", groups),
                    100.0 * metrics::mean(means),
                    own)};
  }
  for (auto& [method, loss] : losses) {
    if (loss.scores > 1) {
      loss.finding.what += fmt::format("; likewise {} more of its scores", loss.scores - 1);
    }
    out.findings.push_back(std::move(loss.finding));
  }
  for (const auto& [reach, methods] : few) {
    std::size_t needed = 1;
    while (least_p_of(needed) >= reach.second && needed < 1000) ++needed;
    out.notes.push_back(fmt::format(
        "no test for small consistent losses of {}: {} independent {} reach at best p = {:.2g}, "
        "level {} needs {}",
        methods.size() == 1 ? *methods.begin() : fmt::format("{} methods", methods.size()),
        reach.first,
        reach.first == 1 ? "run" : "runs or groups",
        least_p_of(reach.first),
        reach.second,
        needed));
  }
}

}  // namespace loopbench::harness
