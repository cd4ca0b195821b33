#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/graph_checks.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kVotes = 3, kFewestForVotes = 10;
constexpr double kLeastFalseGap = 2.0;  // [m]; smaller gaps are no false closures

/// The end of one closure over another path between its keyframes.
struct Gap {
  double distance = 0.0;  ///< [m]
  double length = 0.0;    ///< of the odometry on the path, at least 1 m
};

/// Gaps over other closures: over the three from which the sections of odometry are shortest,
/// because drift is smaller along these. `closures` are sorted by their ends; of these, the nearest
/// are compared.
std::vector<Gap> gaps_over_closures(const std::vector<const Edge*>& closures,
                                    std::size_t index,
                                    const Chain& chain) {
  constexpr double kClosureLength = 2.0;  // [m]
  constexpr std::size_t kCompared = 20;   // before and after
  const Edge& edge = *closures[index];
  std::vector<Gap> out;
  const std::size_t end = std::min(closures.size(), index + kCompared + 1);
  for (std::size_t j = index - std::min(index, kCompared); j < end; ++j) {
    const Edge& other = *closures[j];
    const double length =
        kClosureLength + chain.length(edge.from, other.from) + chain.length(edge.to, other.to);
    if (j == index || length >= chain.length(edge.from, edge.to)) continue;
    const Pose around = chain.between(edge.from, other.from) * other.from_from_to *
                        chain.between(other.to, edge.to);
    out.push_back({log_se3(edge.from_from_to.inverse() * around).head<3>().norm(), length});
  }
  std::ranges::sort(out, {}, &Gap::length);
  out.resize(std::min(kVotes, out.size()));
  return out;
}

/// Eight times the drift of most gaps, over their lengths.
double most_drift(const std::vector<Gap>& gaps) {
  constexpr double kMost = 0.35, kOverUsual = 8.0;
  constexpr std::size_t kFewest = 4;
  std::vector<double> drifts;
  for (const Gap& gap : gaps) drifts.push_back(gap.distance / gap.length);
  return drifts.size() < kFewest ? kMost : std::min(kMost, kOverUsual * median_value(drifts));
}

/// A gap over its limit.
struct FalseClosure {
  const Edge* closure = nullptr;
  Gap gap;
  double over = 0.0;
};

}  // namespace

GapCheck check_gaps(const std::vector<Edge>& closures, const Chain& chain) {
  std::vector<const Edge*> sorted;
  for (const Edge& edge : closures) sorted.push_back(&edge);
  std::ranges::stable_sort(sorted, {}, [](const Edge* e) { return std::max(e->from, e->to); });
  std::vector<Gap> of_odometry, of_closures;
  std::vector<std::vector<Gap>> votes;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    of_odometry.push_back(
        {gap_of(*sorted[i], chain), std::max(1.0, chain.length(sorted[i]->from, sorted[i]->to))});
    votes.push_back(gaps_over_closures(sorted, i, chain));
    of_closures.push_back(votes[i].empty() ? of_odometry[i] : votes[i].front());
  }
  const auto over = [](const Gap& gap, double limit) {
    return gap.distance > kLeastFalseGap ? gap.distance / (kLeastFalseGap + limit * gap.length)
                                         : 0.0;
  };
  const double drift = most_drift(of_odometry), drift_of_closures = most_drift(of_closures);
  GapCheck out;
  FalseClosure worst;
  double squares = 0.0, squares_of_false = 0.0;  // of gaps [m^2]
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    FalseClosure each{sorted[i], of_odometry[i], over(of_odometry[i], drift)};
    double distance = each.gap.distance;
    if (votes[i].size() == kVotes && sorted.size() >= kFewestForVotes) {
      const auto size = [&](const Gap& gap) { return over(gap, drift_of_closures); };
      std::ranges::sort(votes[i], {}, size);
      const Gap& middle = votes[i][kVotes / 2];  // a false one among them is outvoted
      distance = middle.distance;
      if (size(middle) > each.over) each = {sorted[i], middle, size(middle)};
    }
    const bool is_false = each.over > 1.0;
    (is_false ? squares_of_false : squares) += distance * distance;
    if (is_false) out.closures.push_back(static_cast<std::size_t>(sorted[i] - closures.data()));
    if (each.over > worst.over) worst = each;
  }
  const auto rms = [](double sum, std::size_t count) {
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
  };
  constexpr double kMostLeft = 0.9;
  const double before = rms(squares + squares_of_false, closures.size());
  const double after = rms(squares, closures.size() - out.closures.size());
  if (out.closures.empty() || after > kMostLeft * before) return {};
  out.finding = InputFinding{
      Fault::closure_gap,
      fmt::format("{} of {} closures contradict the odometry or other closures, most of all {} -> "
                  "{}: the gap is {:.3g} m after {:.3g} m; without them, rms of the gaps {:.3g} -> "
                  "{:.3g} m",
                  out.closures.size(),
                  closures.size(),
                  worst.closure->from,
                  worst.closure->to,
                  worst.gap.distance,
                  worst.gap.length,
                  before,
                  after),
      "check them; robust methods are made for false closures",
      std::max(1.0 - after / before, 1.0 - 1.0 / worst.over),
      static_cast<double>(out.closures.size())};
  return out;
}

}  // namespace loopbench::metrics
