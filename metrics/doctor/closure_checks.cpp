#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kVotes = 3, kFewestForVotes = 10;

/// Residual of a loop: the distance from the end of its closure to the end of another path.
struct LoopResidual {
  double distance = 0.0;  ///< [m]
  double length = 0.0;    ///< of the odometry on the path, at least 1 m
};

struct CheckedClosure {
  const Edge* edge = nullptr;
  double angle = 0.0;  ///< of the residual over the odometry [rad]
  LoopResidual over_odometry;
  std::vector<LoopResidual> over_closures;  ///< see residuals_over_closures()
  LoopResidual largest = {};                ///< relative to its limit
  double excess = 0.0;                      ///< of the largest over its limit; 1: contradicted
  double distance = 0.0;                    ///< for the rms of all closures [m]
};

/// Residuals over other closures: over the three from which the sections of odometry are shortest,
/// because drift is smaller along these. `closures` are sorted by their ends; of these, the nearest
/// are compared.
std::vector<LoopResidual> residuals_over_closures(const std::vector<const Edge*>& closures,
                                                  std::size_t index,
                                                  const Chain& chain) {
  constexpr double kClosureLength = 2.0;  // [m]
  constexpr std::size_t kCompared = 20;   // before and after
  const Edge& edge = *closures[index];
  std::vector<LoopResidual> out;
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
  std::ranges::sort(out, {}, &LoopResidual::length);
  out.resize(std::min(kVotes, out.size()));
  return out;
}

/// Sorted by their ends.
std::vector<CheckedClosure> with_residuals(const std::vector<Edge>& closures, const Chain& chain) {
  const std::vector<const Edge*> sorted = sorted_by_ends(closures);
  std::vector<CheckedClosure> out;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Edge& edge = *sorted[i];
    const Pose residual = loop_residual(edge, chain);
    out.push_back({&edge,
                   log_so3(residual.rotation).norm(),
                   {residual.translation.norm(), std::max(1.0, chain.length(edge.from, edge.to))},
                   residuals_over_closures(sorted, i, chain)});
  }
  return out;
}

/// Six times the drift of most loops, over their lengths.
double most_drift(const std::vector<LoopResidual>& residuals) {
  constexpr double kMost = 0.35, kOverUsual = 6.0;
  constexpr std::size_t kFewest = 4;
  std::vector<double> drifts;
  for (const LoopResidual& each : residuals) drifts.push_back(each.distance / each.length);
  return drifts.size() < kFewest ? kMost : std::min(kMost, kOverUsual * median_value(drifts));
}

/// Residuals up to which closures are plausible.
struct ResidualLimits {
  double least = 0.0;                               ///< [m]; smaller ones are no false closures
  double over_odometry = 0.0, over_closures = 0.0;  ///< most drift on both kinds of paths [-]
  bool are_all_false = false;

  double excess(const LoopResidual& residual, double drift) const {
    return residual.distance > least ? residual.distance / (least + drift * residual.length) : 0.0;
  }
};

ResidualLimits limits_of(const std::vector<CheckedClosure>& closures, const Chain& chain) {
  constexpr double kMostAngle = 1.3;  // [rad]; odometry is nearer to true closures
  std::vector<LoopResidual> over_odometry, over_closures;
  std::vector<double> distances, angles;
  for (const CheckedClosure& each : closures) {
    over_odometry.push_back(each.over_odometry);
    over_closures.push_back(each.over_closures.empty() ? each.over_odometry
                                                       : each.over_closures.front());
    distances.push_back(each.over_odometry.distance);
    angles.push_back(each.angle);
  }
  const double spread = spread_of(chain.poses.size(), [&](std::size_t i) -> const Vector3& {
    return chain.poses[i].translation;
  });
  const double usual = median_value(std::move(distances));
  return {std::clamp(20.0 * usual, 0.3, std::clamp(0.3 * spread, 0.3, 2.0)),
          most_drift(over_odometry),
          most_drift(over_closures),
          median_value(std::move(angles)) > kMostAngle};
}

/// The larger excess: over the odometry, or with enough closures, the middle one of those over
/// three other closures, of which a false one is outvoted.
void measure_excess(CheckedClosure& closure, const ResidualLimits& limits, bool has_votes) {
  closure.largest = closure.over_odometry;
  closure.distance = closure.largest.distance;
  closure.excess = limits.excess(closure.largest, limits.over_odometry);
  if (!has_votes || closure.over_closures.size() != kVotes) return;
  const auto excess = [&](const LoopResidual& each) {
    return limits.excess(each, limits.over_closures);
  };
  std::ranges::sort(closure.over_closures, {}, excess);
  const LoopResidual& middle = closure.over_closures[kVotes / 2];
  closure.distance = middle.distance;
  if (!(excess(middle) > closure.excess)) return;
  closure.largest = middle;
  closure.excess = excess(middle);
}

/// "3 -> 90 (gap of 2.1 m after 60 m), ...", the largest first.
std::string list_of(const std::vector<CheckedClosure>& closures) {
  constexpr std::size_t kListed = 5;
  std::string out;
  for (std::size_t i = 0; i < std::min(kListed, closures.size()); ++i) {
    out += fmt::format("{}{} -> {} (gap of {:.3g} m after {:.3g} m)",
                       out.empty() ? "" : ", ",
                       closures[i].edge->from,
                       closures[i].edge->to,
                       closures[i].largest.distance,
                       closures[i].largest.length);
  }
  return out;
}

struct ResidualCheck {
  std::optional<InputFinding> finding;
  std::vector<Edge> plausible;  ///< closures without the false ones; all if there is no finding
};

/// Closures that end more than 2 m from the odometry along their loop and more than six times the
/// drift per distance of the median loop (at most 35 % of the loop's length). With at least ten
/// closures, the same for the paths over odometry and one other closure: two of the three shortest
/// have to contradict. A finding if the residuals are smaller by 10 % without them.
/// O(closures log).
ResidualCheck check_residuals(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kMostLeft = 0.9;
  std::vector<CheckedClosure> all = with_residuals(closures, chain);
  const ResidualLimits limits = limits_of(all, chain);
  ResidualCheck out;
  std::vector<CheckedClosure> contradicted;
  double squares = 0.0, squares_of_false = 0.0;  // of distances [m^2]
  for (CheckedClosure& closure : all) {
    measure_excess(closure, limits, all.size() >= kFewestForVotes);
    const bool is_false = closure.excess > 1.0 || limits.are_all_false;
    (is_false ? squares_of_false : squares) += closure.distance * closure.distance;
    if (is_false) {
      contradicted.push_back(closure);
    } else {
      out.plausible.push_back(*closure.edge);
    }
  }
  const auto rms = [](double sum, std::size_t count) {
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
  };
  const double before = rms(squares + squares_of_false, closures.size());
  const double after = rms(squares, out.plausible.size());
  if (contradicted.empty() || after > kMostLeft * before) return {std::nullopt, closures};
  std::ranges::stable_sort(contradicted, std::greater{}, &CheckedClosure::excess);
  const bool is_all = out.plausible.empty();
  out.finding = InputFinding{
      Fault::closure_gap,
      fmt::format("{} of {} closures contradict the odometry or other closures, most of all {}",
                  contradicted.size(),
                  closures.size(),
                  list_of(contradicted)) +
          (is_all
               ? ""
               : fmt::format("; without them, rms of the gaps {:.3g} -> {:.3g} m", before, after)),
      is_all ? "check units, frames and order of quaternions of all edges"
             : "check them; robust methods are made for false closures",
      std::max(1.0 - after / before, 1.0 - 1.0 / contradicted.front().excess),
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
  const ResidualCheck residuals = check_residuals(measured.closures, chain);
  const std::size_t count = measured.closures.size();
  const bool are_few_false = 5 * (count - residuals.plausible.size()) < count;
  auto repair = find_closure_repair(measured, chain);
  if (!repair) repair = find_closure_repair_by_keyframes(measured);
  // Smaller translations of all closures also shrink the gaps of a few false ones.
  const bool is_unit = repair && repair->fault == Fault::closure_unit;
  if (repair && !(is_unit && residuals.finding && are_few_false)) {
    out.push_back(std::move(*repair));
    return out;
  }
  if (residuals.finding) out.push_back(*residuals.finding);
  if (are_few_false) {  // false closures show nothing about the information
    measured.closures = residuals.plausible;
    if (auto found = check_information(measured)) out.push_back(*found);
  }
  std::erase_if(out, [](const InputFinding& f) { return f.confidence < kLeastConfidence; });
  return out;
}

}  // namespace loopbench::metrics
