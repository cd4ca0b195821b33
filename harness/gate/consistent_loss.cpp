#include "harness/gate/consistent_loss.hpp"

#include <fmt/format.h>

#include <cmath>

#include "harness/statistics/average.hpp"
#include "harness/statistics/differences.hpp"
#include "harness/statistics/holm.hpp"
#include "harness/statistics/signed_rank.hpp"

namespace loopbench {

void ConsistentLosses::add(const std::string& method,
                           const std::string& score,
                           const Tolerance& limit,
                           Better way,
                           double before,
                           double now) {
  if (!limit.alpha || way == Better::neither || way == Better::target) return;
  Series& series = series_[{method, score}];
  series.before.push_back(before);
  series.now.push_back(now);
  series.way = way;
  series.limit = limit;
}

std::vector<Finding> ConsistentLosses::findings() const {
  std::vector<double> p;
  std::vector<Differences> moves;
  for (const auto& [who, series] : series_) {
    moves.push_back(paired_differences(series.now, series.before, series.limit.tie));
    const Alternative worse =
        series.way == Better::higher ? Alternative::less : Alternative::greater;
    p.push_back(signed_rank(moves.back().values, {.alternative = worse}).p);
  }
  const std::vector<double> adjusted = holm(p);
  std::vector<Finding> out;
  std::size_t i = 0;
  for (const auto& [who, series] : series_) {
    const double own_p = adjusted[i];
    const Differences& move = moves[i++];
    if (own_p >= *series.limit.alpha) continue;
    const double middle = mean(move.values);
    out.push_back(
        {Finding::Kind::regression,
         who.first,
         who.second,
         fmt::format("{} worse over {} runs, by {:.3g}{} on average: p = {:.2g}",
                     series.limit.value,
                     series.now.size(),
                     move.is_ratio ? 100.0 * std::abs(std::expm1(middle)) : std::abs(middle),
                     move.is_ratio ? " %" : "",
                     own_p)});
  }
  return out;
}

}  // namespace loopbench
