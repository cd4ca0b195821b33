#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"
#include "metrics/numerics/angle.hpp"

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

/// Eight times the drift of most gaps, over their lengths.
double most_drift(const std::vector<Gap>& gaps) {
  constexpr double kMost = 0.35, kOverUsual = 8.0;
  constexpr std::size_t kFewest = 4;
  std::vector<double> drifts;
  for (const Gap& gap : gaps) drifts.push_back(gap.distance / gap.length);
  return drifts.size() < kFewest ? kMost : std::min(kMost, kOverUsual * median_value(drifts));
}

struct GapCheck {
  std::optional<InputFinding> finding;
  std::vector<Edge> plausible;  ///< closures without the false ones; all if there is no finding
};

/// Closures that end more than 2 m from the odometry along their loop and more than eight times the
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
  // Smaller gaps are no false closures [m].
  const double least = std::clamp(20.0 * median_value(std::move(distances)), 0.3, 2.0);
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

/// The loops of a problem in groups, and the noise that fits each; loops alone if there are few, so
/// that a false one among them is outvoted.
struct GroupFits {
  explicit GroupFits(const Problem& problem)
      : chain(chain_of(problem)),
        groups(loop_groups(problem.closures, chain, problem.closures.size() < 6 ? 1 : 5)) {
    for (const LoopGroup& group : groups) fits.push_back(group.fit(group.as_read()));
  }

  Chain chain;
  std::vector<LoopGroup> groups;
  std::vector<LoopFit> fits;
};

/// Edges whose variances are wrong by the median factors of every other group; these have to make
/// the remaining groups likelier (all, if there are few).
std::optional<InputFinding> wrong_scale(const GroupFits& loops) {
  constexpr double kTooSmall = 100.0, kTooLarge = 1e-5;  // fitted over stated variance
  constexpr double kExact = 1e-8;  // smaller ones are those of closures without noise
  constexpr double kSmallLoss = 15.0, kLeastProven = 3.0;  // in logarithms of the likelihood
  const std::size_t step = loops.groups.size() < 6 ? 1 : 2;
  const auto factor = [&](std::size_t kind) {
    std::vector<double> logarithms;
    for (std::size_t i = 0; i < loops.fits.size(); i += step) {
      logarithms.push_back(loops.fits[i].factors[kind]);
    }
    std::ranges::sort(logarithms, {}, [](double x) { return std::abs(x); });
    return logarithms[(logarithms.size() - 1) / 2];  // of two, the one that accuses less
  };
  const auto gain_by = [&](const std::array<double, 2>& factors) {
    double out = 0.0;
    for (std::size_t i = step - 1; i < loops.groups.size(); i += step) {
      out += loops.groups[i].log_likelihood(factors) - loops.groups[i].log_likelihood({});
    }
    return out;
  };
  const double f = factor(0), c = factor(1);
  const bool is_odometry = std::exp(f) < kTooLarge || std::exp(f) > kTooSmall;
  const bool is_closures =
      std::exp(c) > kTooSmall || (std::exp(c) < kTooLarge && std::exp(c) > kExact);
  if (!is_odometry && !is_closures) return std::nullopt;
  const double most_loss = kSmallLoss * static_cast<double>(loops.groups.size() / step);
  const std::array<double, 2> of_all{f, f}, of_some{is_odometry ? f : 0.0, is_odometry ? 0.0 : c};
  const bool is_all =
      std::abs(f) > std::log(kTooSmall) && gain_by(of_some) - gain_by(of_all) < most_loss;
  const double proven = gain_by(is_all ? of_all : of_some);
  if (proven < kLeastProven) return std::nullopt;
  const double scale = std::exp(is_all || is_odometry ? f : c);
  const char* const edges = is_all ? "all edges" : is_odometry ? "the odometry" : "the closures";
  return InputFinding{
      Fault::information_scale,
      fmt::format("the gaps of the loops are likelier with the stated variances of {} times {:.1g} "
                  "(median of {} groups of loops; logarithm of the ratio of likelihoods {:.1f})",
                  edges,
                  scale,
                  loops.groups.size(),
                  proven),
      fmt::format("check the information of {}; for a trajectory: options {}{}",
                  edges,
                  is_all || is_odometry ? "odometry.sigma_*" : "closures.sigma_*",
                  is_all ? ", closures.sigma_*" : ""),
      0.8,
      scale};
}

/// Exchanged blocks of all information, or information that differs from the noise which makes the
/// loops likeliest by more than 100 (too large) or 10^5 (too small).
std::optional<InputFinding> check_information(const Problem& problem) {
  constexpr std::size_t kFewest = 2;
  constexpr double kLeastOfOrder = 18.0;  // mean of the groups, in logarithms of the likelihood
  constexpr double kExactGap = 1e-4;      // [m]; of measurements without noise
  if (problem.closures.size() < kFewest) return std::nullopt;
  const GroupFits as_read(problem);
  std::vector<double> gaps;
  for (const Edge& closure : problem.closures)
    gaps.push_back(gap_of(closure, as_read.chain).translation.norm());
  if (median_value(std::move(gaps)) < kExactGap) return std::nullopt;
  const auto gained_by = [&](auto change) {
    Problem other = problem;
    for (auto* edges : {&other.odometry, &other.closures}) {
      for (Edge& edge : *edges) edge.information = change(edge.information);
    }
    return gain(as_read.fits, GroupFits(other).fits);
  };
  const double exchanged = gained_by([](const Matrix6& information) -> Matrix6 {
    const std::array order{3, 4, 5, 0, 1, 2};
    return information(order, order);
  });
  const double inverted =
      gained_by([](const Matrix6& information) -> Matrix6 { return information.inverse(); });
  const double gained = std::max(exchanged, inverted);
  if (gained > kLeastOfOrder * static_cast<double>(as_read.groups.size())) {
    const bool is_order = exchanged >= inverted;
    return InputFinding{
        is_order ? Fault::information_order : Fault::information_scale,
        fmt::format("{}: logarithm of the ratio of likelihoods of {} groups of loops {:.1f}",
                    is_order ? "exchanging the blocks of translation and rotation"
                             : "inverting the information",
                    as_read.groups.size(),
                    gained),
        is_order ? "check the order of the blocks: g2o has those of x y z first"
                 : "write information, the inverse of covariances",
        1.0 - std::exp(-0.25 * gained),
        gained};
  }
  return wrong_scale(as_read);
}

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  if (problem.closures.empty()) return out;
  if (auto repair = find_repair_by_keyframes(problem)) return {*repair};
  if (problem.odometry.size() + 1 != problem.keyframes.size()) return out;
  Problem measured = problem;
  const Chain chain = chain_of(problem);
  if (auto found = remove_unmeasured(measured.closures, chain)) out.push_back(*found);
  if (measured.closures.empty()) return out;
  const GapCheck gaps = check_gaps(measured.closures, chain);
  const std::size_t count = measured.closures.size();
  const bool are_few_false = 5 * (count - gaps.plausible.size()) < count;
  auto repair = find_closure_repair(measured, chain);
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
