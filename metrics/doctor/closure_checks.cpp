#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"
#include "metrics/numerics/spread.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kVotes = 3, kFewestForVotes = 10;

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

/// Six times the drift of most gaps, over their lengths.
double most_drift(const std::vector<Gap>& gaps) {
  constexpr double kMost = 0.35, kOverUsual = 6.0;
  constexpr std::size_t kFewest = 4;
  std::vector<double> drifts;
  for (const Gap& gap : gaps) drifts.push_back(gap.distance / gap.length);
  return drifts.size() < kFewest ? kMost : std::min(kMost, kOverUsual * median_value(drifts));
}

struct GapCheck {
  std::optional<InputFinding> finding;
  std::vector<Edge> plausible;  ///< closures without the false ones; all if there is no finding
};

/// Closures that end more than 2 m from the odometry along their loop and more than six times the
/// drift per distance of the median loop (at most 35 % of the loop's length). With at least ten
/// closures, the same for the paths over odometry and one other closure: two of the three shortest
/// have to contradict. A finding if the gaps are smaller by 10 % without them. O(closures log).
GapCheck check_gaps(const std::vector<Edge>& closures, const Chain& chain) {
  std::vector<const Edge*> sorted;
  for (const Edge& edge : closures) sorted.push_back(&edge);
  std::ranges::stable_sort(sorted, {}, [](const Edge* e) { return std::max(e->from, e->to); });
  std::vector<Gap> of_odometry, of_closures;
  std::vector<double> distances, angles;
  std::vector<std::vector<Gap>> votes;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Pose gap = gap_of(*sorted[i], chain);
    of_odometry.push_back(
        {gap.translation.norm(), std::max(1.0, chain.length(sorted[i]->from, sorted[i]->to))});
    distances.push_back(gap.translation.norm());
    angles.push_back(log_so3(gap.rotation).norm());
    votes.push_back(gaps_over_closures(sorted, i, chain));
    of_closures.push_back(votes[i].empty() ? of_odometry[i] : votes[i].front());
  }
  constexpr double kMostAngle = 1.3;  // [rad]; odometry is nearer to true closures
  const bool are_all_false = median_value(std::move(angles)) > kMostAngle;
  const double spread = spread_of(chain.poses.size(), [&](std::size_t i) -> const Vector3& {
    return chain.poses[i].translation;
  });
  // Smaller gaps are no false closures [m].
  const double least = std::clamp(
      20.0 * median_value(std::move(distances)), 0.3, std::clamp(0.3 * spread, 0.3, 2.0));
  const auto over = [&](const Gap& gap, double limit) {
    return gap.distance > least ? gap.distance / (least + limit * gap.length) : 0.0;
  };
  const double drift = most_drift(of_odometry), drift_of_closures = most_drift(of_closures);
  struct Contradicted {
    double size = 0.0;  ///< of the gap, over its limit
    const Edge* edge = nullptr;
    Gap gap;
  };
  GapCheck out;
  std::vector<Contradicted> contradicted;
  double squares = 0.0, squares_of_false = 0.0;  // of gaps [m^2]
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    Gap gap = of_odometry[i];
    double size = over(gap, drift), distance = gap.distance;
    if (votes[i].size() == kVotes && sorted.size() >= kFewestForVotes) {
      const auto by_size = [&](const Gap& each) { return over(each, drift_of_closures); };
      std::ranges::sort(votes[i], {}, by_size);
      const Gap& middle = votes[i][kVotes / 2];  // a false one among them is outvoted
      distance = middle.distance;
      if (by_size(middle) > size) gap = middle;
      size = std::max(size, by_size(middle));
    }
    const bool is_false = size > 1.0 || are_all_false;
    if (is_false) {
      contradicted.push_back({size, sorted[i], gap});
    } else {
      out.plausible.push_back(*sorted[i]);
    }
    (is_false ? squares_of_false : squares) += distance * distance;
  }
  const auto rms = [](double sum, std::size_t count) {
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
  };
  constexpr double kMostLeft = 0.9;
  constexpr std::size_t kListed = 5;
  const double before = rms(squares + squares_of_false, closures.size());
  const double after = rms(squares, out.plausible.size());
  if (contradicted.empty() || after > kMostLeft * before) return {std::nullopt, closures};
  std::ranges::stable_sort(contradicted, std::greater{}, &Contradicted::size);
  std::string list;
  for (std::size_t i = 0; i < std::min(kListed, contradicted.size()); ++i) {
    const auto& [size, edge, gap] = contradicted[i];
    list += fmt::format("{}{} -> {} (gap of {:.3g} m after {:.3g} m)",
                        list.empty() ? "" : ", ",
                        edge->from,
                        edge->to,
                        gap.distance,
                        gap.length);
  }
  const bool is_all = out.plausible.empty();
  out.finding = InputFinding{
      Fault::closure_gap,
      fmt::format("{} of {} closures contradict the odometry or other closures, most of all {}",
                  contradicted.size(),
                  closures.size(),
                  list) +
          (is_all
               ? ""
               : fmt::format("; without them, rms of the gaps {:.3g} -> {:.3g} m", before, after)),
      is_all ? "check units, frames and order of quaternions of all edges"
             : "check them; robust methods are made for false closures",
      std::max(1.0 - after / before, 1.0 - 1.0 / contradicted.front().size),
      static_cast<double>(contradicted.size())};
  return out;
}

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  if (auto repair = find_odometry_repair(problem)) return {*repair};
  if (problem.closures.empty()) return out;
  if (problem.odometry.size() + 1 != problem.keyframes.size()) {
    if (auto repair = find_closure_repair_by_keyframes(problem)) out.push_back(*repair);
    return out;
  }
  Problem measured = problem;
  const Chain chain = chain_of(problem);
  if (auto found = remove_unmeasured(measured.closures, chain)) out.push_back(*found);
  if (measured.closures.empty()) return out;
  const GapCheck gaps = check_gaps(measured.closures, chain);
  const std::size_t count = measured.closures.size();
  const bool are_few_false = 5 * (count - gaps.plausible.size()) < count;
  auto repair = find_closure_repair(measured, chain);
  if (!repair) repair = find_closure_repair_by_keyframes(measured);
  // Smaller translations of all closures also shrink the gaps of a few false ones.
  const bool is_unit = repair && repair->fault == Fault::closure_unit;
  if (repair && !(is_unit && gaps.finding && are_few_false)) {
    out.push_back(std::move(*repair));
    return out;
  }
  if (gaps.finding) out.push_back(*gaps.finding);
  if (are_few_false) {  // false closures show nothing about the information
    measured.closures = gaps.plausible;
    if (auto found = check_information(measured)) out.push_back(*found);
  }
  std::erase_if(out, [](const InputFinding& f) { return f.confidence < kLeastConfidence; });
  return out;
}

}  // namespace loopbench::metrics
