#include "harness/export/mark_best.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/statistics/average.hpp"
#include "harness/statistics/differences.hpp"
#include "harness/statistics/holm.hpp"
#include "harness/statistics/signed_rank.hpp"

namespace loopbench {
namespace {

double mean_of(const ByRun& runs) {
  std::vector<double> values;
  for (const auto& [run, value] : runs) values.push_back(value);
  return mean(values);
}

double p_value(const ByRun& a, const ByRun& b) {
  std::vector<double> left;
  std::vector<double> right;
  for (const auto& [run, value] : a) {
    const auto other = b.find(run);
    if (other == b.end()) continue;
    left.push_back(value);
    right.push_back(other->second);
  }
  return signed_rank(paired_differences(left, right).values).p;
}

}  // namespace

const char* mark_name(Mark mark) {
  return mark == Mark::best ? "best" : mark == Mark::second ? "second" : "";
}

Marks mark_best(const std::vector<ByRun>& competitors, bool higher, double alpha) {
  Marks out{std::vector<Mark>(competitors.size(), Mark::none), ""};
  std::vector<std::size_t> order;
  std::set<std::string> runs;
  for (std::size_t i = 0; i < competitors.size(); ++i) {
    if (!competitors[i].empty()) order.push_back(i);
    for (const auto& [run, value] : competitors[i]) runs.insert(run);
  }
  if (order.size() < 2) return out;
  const std::size_t pairs = order.size() * (order.size() - 1) / 2;
  // The last of Holm's steps asks for alpha itself, the first for alpha over all pairs.
  if (least_p(runs.size()) > alpha) {
    out.why_none = fmt::format("{} run{} a cell cannot show a difference at {} (least p {:.2g})",
                               runs.size(),
                               runs.size() == 1 ? "" : "s",
                               alpha,
                               least_p(runs.size()));
    return out;
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    const double left = mean_of(competitors[a]);
    const double right = mean_of(competitors[b]);
    return higher ? left > right : left < right;
  });
  std::vector<double> p;
  p.reserve(pairs);
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      p.push_back(p_value(competitors[order[a]], competitors[order[b]]));
    }
  }
  const std::vector<double> adjusted = holm(p);
  const auto beats_the_rest = [&](std::size_t begin, std::size_t count) {
    return std::all_of(adjusted.begin() + static_cast<std::ptrdiff_t>(begin),
                       adjusted.begin() + static_cast<std::ptrdiff_t>(begin + count),
                       [&](double value) { return value < alpha; });
  };
  const auto is_whole = [&](std::size_t i) { return competitors[order[i]].size() == runs.size(); };
  if (!is_whole(0) || !beats_the_rest(0, order.size() - 1)) return out;
  out.marks[order[0]] = Mark::best;
  if (order.size() > 2 && is_whole(1) && beats_the_rest(order.size() - 1, order.size() - 2)) {
    out.marks[order[1]] = Mark::second;
  }
  return out;
}

}  // namespace loopbench
