#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/edge_repair.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

std::vector<LoopFit> fits(const std::vector<const LoopGroup*>& groups,
                          const Chain& chain,
                          const EdgeRepair& repair) {
  std::vector<LoopFit> out;
  for (const LoopGroup* group : groups) {
    std::vector<Pose> measured;
    Rotation previous = Rotation::Identity();  // of the gap
    for (const Edge* edge : group->closures()) {
      const Rotation odometry = chain.between(edge->from, edge->to).rotation;
      const EdgeContext context{
          odometry * previous.conjugate(), chain.in_world(edge->from), chain.in_world(edge->to)};
      measured.push_back(repair.change(edge->from_from_to, context));
      previous = measured.back().rotation.conjugate() * odometry;
    }
    out.push_back(group->fit(measured));
    out.back().log_likelihood -= static_cast<double>(measured.size()) * repair.penalty_of_closure;
  }
  return out;
}

/// Median error with which odometry and other closures predict a closure.
double median_error(const std::vector<LoopFit>& fits, std::vector<double> LoopFit::*errors) {
  std::vector<double> all;
  for (const LoopFit& fit : fits) std::ranges::copy(fit.*errors, std::back_inserter(all));
  return median_value(std::move(all)) + 1e-6;  // rounding
}

/// Median differences of edges and keyframes: of translations over the keyframes' median, plus of
/// rotations [rad].
double error_to_keyframes(const std::vector<Edge>& edges,
                          const Trajectory& keyframes,
                          const EdgeRepair& repair) {
  std::vector<double> errors, angles, steps;
  const auto keyframe = [&](std::size_t index) {
    const Pose& as_read = keyframes[index].world_from_body;
    return repair.is_of_vertices ? repair.change(as_read, {}) : as_read;
  };
  for (const Edge& edge : edges) {
    const Pose step = keyframe(edge.from).inverse() * keyframe(edge.to);
    const Pose changed =
        repair.change(edge.from_from_to, {step.rotation, keyframe(edge.from), keyframe(edge.to)});
    errors.push_back((changed.translation - step.translation).norm());
    angles.push_back(angle_between(changed.rotation, step.rotation));
    steps.push_back(step.translation.norm());
  }
  const double step = median_value(std::move(steps)), angle = median_value(std::move(angles));
  return step > 0.0 ? median_value(std::move(errors)) / step + angle : 0.0;
}

/// The repair with which `edges` agree best with the keyframes, if they do not as read.
std::optional<InputFinding> repair_by_keyframes(const std::vector<Edge>& edges,
                                                const Trajectory& keyframes,
                                                const std::vector<EdgeRepair>& repairs) {
  constexpr double kBad = 0.3, kBetter = 0.3;
  constexpr std::size_t kFewest = 3;  // one fits several repairs
  const double before = error_to_keyframes(edges, keyframes, as_read_edge());
  if (before < kBad || edges.size() < kFewest) return std::nullopt;
  double after = kBetter * before;
  const EdgeRepair* best = nullptr;
  for (const EdgeRepair& repair : repairs) {
    const double error = error_to_keyframes(edges, keyframes, repair);
    if (error >= after) continue;
    after = error;
    best = &repair;
  }
  if (best == nullptr) return std::nullopt;
  return InputFinding{best->fault,
                      fmt::format("{}: difference to the vertices {:.3g} -> {:.3g} (of a step, and "
                                  "rad)",
                                  best->what,
                                  before,
                                  after),
                      best->fix,
                      1.0 - after / before,
                      static_cast<double>(edges.size())};
}

}  // namespace

std::optional<InputFinding> find_odometry_repair(const Problem& problem) {
  return repair_by_keyframes(problem.odometry, problem.keyframes, odometry_repairs());
}

std::optional<InputFinding> find_closure_repair_by_keyframes(const Problem& problem) {
  return repair_by_keyframes(problem.closures, problem.keyframes, closure_repairs());
}

std::optional<InputFinding> remove_unmeasured(std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kExact = 1e-9, kLeastPart = 0.2;
  constexpr double kLeastGap = 0.05, kLeastAngle = 0.1;  // [m], [rad]
  constexpr std::size_t kFewest = 2;
  const std::size_t all = closures.size();
  std::vector<Edge> measured;
  std::vector<double> gaps, angles;
  bool has_positions = false;
  for (const Edge& edge : closures) {
    if (edge.from_from_to.rotation.vec().norm() > kExact) {
      measured.push_back(edge);
      continue;
    }
    const Pose gap = loop_residual(edge, chain);
    gaps.push_back(gap.translation.norm());
    angles.push_back(log_so3(gap.rotation).norm());
    has_positions |= edge.from_from_to.translation.norm() > kExact;
  }
  const std::size_t count = gaps.size();
  const double gap = median_value(std::move(gaps)), angle = median_value(std::move(angles));
  const bool are_few = static_cast<double>(count) < kLeastPart * static_cast<double>(all);
  const bool is_close = has_positions ? angle < kLeastAngle : gap < kLeastGap;
  if (count < kFewest || are_few || is_close) return std::nullopt;
  closures = std::move(measured);
  return InputFinding{
      has_positions ? Fault::closure_rotation : Fault::closure_gap,
      fmt::format(
          "{} of {} closures state exactly the same {} at both ends, where the odometry has "
          "a median {}: it was not measured",
          count,
          all,
          has_positions ? "rotation" : "pose",
          has_positions ? fmt::format("angle of {:.3g} deg", kDegrees * angle)
                        : fmt::format("distance of {:.3g} m", gap)),
      "measure the relative poses (registration), or state their information for positions only",
      0.7,
      static_cast<double>(count)};
}

namespace {

/// Fits of the same groups before and after a repair.
struct Comparison {
  std::vector<LoopFit> was, is;

  double gained() const { return gain(was, is); }
  double ratio(std::vector<double> LoopFit::*errors) const {
    return median_error(is, errors) / median_error(was, errors);
  }
  /// Whether one error shrinks, and none grows.
  bool is_better(double most_ratio, double most_radians) const {
    constexpr double kMostGrowth = 1.1;
    const auto [smaller, larger] = std::minmax({ratio(&LoopFit::metres), ratio(&LoopFit::radians)});
    return smaller < most_ratio && larger < kMostGrowth &&
           median_error(is, &LoopFit::radians) < most_radians;
  }

  InputFinding finding(Fault::Name fault,
                       const std::string& what,
                       const std::string& fix,
                       double value) const {
    return {fault,
            fmt::format("{}: error with which odometry and other closures predict a closure {:.3g} "
                        "-> {:.3g} m, {:.3g} -> {:.3g} deg (logarithm of the ratio of likelihoods "
                        "{:.1f})",
                        what,
                        median_error(was, &LoopFit::metres),
                        median_error(is, &LoopFit::metres),
                        kDegrees * median_error(was, &LoopFit::radians),
                        kDegrees * median_error(is, &LoopFit::radians),
                        gained()),
            fix,
            1.0 - std::exp(-0.25 * gained()),
            value};
  }
};

/// Inverted odometry, if it explains the groups with even indices better than `best_fits` do.
std::optional<InputFinding> find_inverted_odometry(Problem problem,
                                                   const std::vector<LoopGroup>& as_read,
                                                   const std::vector<LoopFit>& best_fits,
                                                   double least_gain,
                                                   std::size_t step) {
  constexpr double kMostRatio = 0.5, kMostRadians = 0.9;
  for (Edge& edge : problem.odometry) edge.from_from_to = edge.from_from_to.inverse();
  const Chain chain = chain_of(problem);
  Comparison all, chosen;
  const std::vector<LoopGroup> groups = loop_groups(problem.closures, chain);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    all.was.push_back(as_read[i].fit(as_read[i].as_read()));
    all.is.push_back(groups[i].fit(groups[i].as_read()));
    if (i % step == 0) chosen.is.push_back(all.is.back());
  }
  chosen.was = best_fits;
  if (chosen.gained() < least_gain || !all.is_better(kMostRatio, kMostRadians)) {
    return std::nullopt;
  }
  return all.finding(Fault::odometry_direction,
                     "inverting the odometry",
                     "exchange the two vertices of each odometry edge",
                     static_cast<double>(problem.odometry.size()));
}

/// Closures of both directions: of each group, those are inverted that become likelier so.
std::optional<InputFinding> find_inverted_closures(const std::vector<LoopGroup>& groups) {
  constexpr double kLeastGain = 5.0, kLeastProven = 20.0;  // in logarithms of the likelihood
  constexpr double kLeastPart = 0.1, kMostRatio = 0.5, kMostRadians = 0.35;
  Comparison all;
  std::size_t inverted = 0, compared = 0;
  for (const LoopGroup& group : groups) {
    std::vector<Pose> measured = group.as_read();
    all.was.push_back(group.fit(measured));
    all.is.push_back(all.was.back());
    for (Pose& pose : measured) {
      const Pose as_read = std::exchange(pose, pose.inverse());
      LoopFit found = group.fit(measured);
      if (found.log_likelihood < all.is.back().log_likelihood + kLeastGain) {
        pose = as_read;
        continue;
      }
      all.is.back() = std::move(found);
      ++inverted;
    }
    compared += measured.size();
  }
  const double part = static_cast<double>(inverted) / static_cast<double>(compared);
  if (part < kLeastPart || all.gained() < kLeastProven ||
      !all.is_better(kMostRatio, kMostRadians)) {
    return std::nullopt;
  }
  return all.finding(
      Fault::closure_direction,
      fmt::format("inverting {} of {} closures that were compared", inverted, compared),
      "list the vertices of each closure in the order of its measurement",
      static_cast<double>(inverted));
}

}  // namespace

std::optional<InputFinding> find_closure_repair(const Problem& problem, const Chain& chain) {
  constexpr double kLeastChosen = 5.0, kLeastProven = 3.0;  // in logarithms of the likelihood
  constexpr double kMostRadians = 0.9;
  constexpr std::size_t kFewestForHalves = 6;  // fewer groups differ little by chance
  const std::vector<LoopGroup> groups = loop_groups(problem.closures, chain);
  std::vector<const LoopGroup*> chosen, tested;
  const std::size_t step = groups.size() >= kFewestForHalves ? 2 : 1;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i % step == 0) chosen.push_back(&groups[i]);
    if (i % step == step - 1) tested.push_back(&groups[i]);
  }
  for (const bool has_units : {true, false}) {
    // Compared with the best so far: against the file as read, several reach the limit of gain().
    const EdgeRepair* best = &as_read_edge();
    std::vector<LoopFit> best_fits = fits(chosen, chain, *best);
    for (const EdgeRepair& repair : closure_repairs()) {
      if (!has_units && repair.fault == Fault::closure_unit) continue;
      std::vector<LoopFit> found = fits(chosen, chain, repair);
      const double least = (best->fault == repair.fault ? 0.0 : kLeastChosen) - best->penalty;
      if (!(gain(best_fits, found) - repair.penalty > least)) continue;
      best_fits = std::move(found);
      best = &repair;
    }
    if (best == &as_read_edge()) break;
    // Mirrored closures of a car look like inverted odometry, which is the usual mistake.
    const double least = best->fault == Fault::closure_frame ? -10.0 : 5.0;
    if (auto found = find_inverted_odometry(problem, groups, best_fits, least, step)) return found;
    const Comparison proof{fits(tested, chain, as_read_edge()), fits(tested, chain, *best)};
    const bool is_unit = best->fault == Fault::closure_unit;
    if (proof.gained() > kLeastProven && proof.is_better(best->most_ratio, kMostRadians) &&
        (!is_unit || proof.ratio(&LoopFit::metres) < best->most_ratio)) {
      return proof.finding(
          best->fault, best->what, best->fix, static_cast<double>(problem.closures.size()));
    }
    if (!is_unit) break;
  }
  return find_inverted_closures(groups);
}

}  // namespace loopbench::metrics
