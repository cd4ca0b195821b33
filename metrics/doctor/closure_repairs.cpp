#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"
#include "metrics/doctor/signed_axes.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

/// The second argument is the rotation that odometry and the previous closure predict.
using EdgeChange = std::function<Pose(const Pose&, const Rotation&)>;

struct EdgeRepair {
  Fault::Name fault;
  std::string what;
  std::string fix;
  EdgeChange change;
  double penalty = 0.0;             ///< logarithm of the number of alternatives
  double penalty_of_closure = 0.0;  ///< the same for each closure
  bool is_of_vertices = false;      ///< changes them as well as the edges
};

Pose read_in_degrees(const Pose& p, const Rotation& predicted) {
  const Vector3 read = log_so3(p.rotation);
  const double angle = read.norm();
  if (angle == 0.0) return p;
  const Vector3 axis = read / angle;
  // Angles in degrees that were read as radians are known up to full rotations.
  const double expected = kDegrees * log_so3(predicted).dot(axis);
  const double rotations = std::round((expected - angle) / (2.0 * M_PI));
  return {exp_so3((angle + 2.0 * M_PI * rotations) / kDegrees * axis), p.translation};
}

Pose unchanged_edge(const Pose& p, const Rotation&) { return p; }
Pose inverted_edge(const Pose& p, const Rotation&) { return p.inverse(); }
Pose reordered_edge(const Pose& p, const Rotation&) {
  const Rotation& q = p.rotation;
  return {Rotation(q.x(), q.y(), q.z(), q.w()), p.translation};
}

const EdgeRepair kAsRead{{}, "", "", unchanged_edge};

/// Translations of `edges` in millimetres or centimetres, or those of the other edges: what has to
/// be written in metres in these cases.
std::vector<EdgeRepair> unit_repairs(const std::string& edges,
                                     const std::string& if_larger,
                                     const std::string& if_smaller) {
  std::vector<EdgeRepair> out;
  for (const double factor : {0.001, 0.01, 0.3048, 1.0 / 0.3048, 100.0, 1000.0}) {
    out.push_back({Fault::closure_unit,
                   fmt::format("multiplying the translations of {} by {:g}", edges, factor),
                   fmt::format("write {} in metres", factor < 1.0 ? if_larger : if_smaller),
                   [=](const Pose& p, const Rotation&) -> Pose {
                     return {p.rotation, factor * p.translation};
                   }});
  }
  return out;
}

std::vector<EdgeRepair> candidates() {
  std::vector<EdgeRepair> out = unit_repairs("the closures", "the closures", "the odometry");
  out.insert(
      out.end(),
      {{Fault::closure_direction,
        "inverting the closures (or all odometry)",
        "exchange the two vertices of each closure; in a file of loops the first two columns",
        inverted_edge},
       {Fault::closure_rotation,
        "inverting the closures' rotations, but not their translations,",
        "write the rotations that map vectors from the second vertex's body to the first one's",
        [](const Pose& p, const Rotation&) -> Pose {
          return {p.rotation.conjugate(), p.translation};
        }},
       {Fault::closure_rotation,
        "quaternions of the closures in the order w x y z",
        "write their quaternions as x y z w",
        reordered_edge},
       {Fault::closure_rotation,
        "multiplying the closures' angles by 57.3",
        "write their angles in radians, converted once",
        [](const Pose& p, const Rotation&) -> Pose {
          return {exp_so3(kDegrees * log_so3(p.rotation)), p.translation};
        }},
       {Fault::closure_rotation,
        "the closures' angles in degrees",
        "write their angles in radians",
        read_in_degrees,
        0.0,
        std::log(kDegrees)}});
  for (const auto& [axes, option] : signed_axes()) {
    if (axes.determinant() < 0.0) continue;
    const Rotation body(axes);
    out.push_back({Fault::closure_frame,
                   "taking " + option + " of the closures' body as x,y,z",
                   "transform them into the odometry's body: C T C^-1 for each closure T",
                   [=](const Pose& p, const Rotation&) -> Pose {
                     return {body * p.rotation * body.conjugate(), body * p.translation};
                   },
                   std::log(24.0)});
  }
  return out;
}

std::vector<LoopFit> fits(const std::vector<const LoopGroup*>& groups,
                          const Chain& chain,
                          const EdgeRepair& repair) {
  std::vector<LoopFit> out;
  for (const LoopGroup* group : groups) {
    std::vector<Pose> measured;
    Rotation previous = Rotation::Identity();  // of the gap
    for (const Edge* edge : group->closures()) {
      const Rotation odometry = chain.between(edge->from, edge->to).rotation;
      measured.push_back(repair.change(edge->from_from_to, odometry * previous.conjugate()));
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
    return repair.is_of_vertices ? repair.change(as_read, as_read.rotation) : as_read;
  };
  for (const Edge& edge : edges) {
    const Pose step = keyframe(edge.from).inverse() * keyframe(edge.to);
    const Pose changed = repair.change(edge.from_from_to, step.rotation);
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
  const double before = error_to_keyframes(edges, keyframes, kAsRead);
  if (before < kBad) return std::nullopt;
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

std::optional<InputFinding> find_repair_by_keyframes(const Problem& problem) {
  std::vector<EdgeRepair> all =
      unit_repairs("the odometry", "all edges and vertices", "all edges and vertices");
  all.push_back({Fault::odometry_direction,
                 "inverting the odometry",
                 "exchange the two vertices of each odometry edge",
                 inverted_edge});
  all.push_back({Fault::quaternion_order,
                 "all quaternions in the order w x y z",
                 "write the quaternions of all edges and vertices as x y z w",
                 reordered_edge,
                 0.0,
                 0.0,
                 true});
  if (auto found = repair_by_keyframes(problem.odometry, problem.keyframes, all)) return found;
  return repair_by_keyframes(problem.closures, problem.keyframes, candidates());
}

std::optional<InputFinding> remove_unmeasured(std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kExact = 1e-9, kLeastPart = 0.2, kLeastGap = 0.05;  // [m], [-], [m]
  constexpr std::size_t kFewest = 2;
  const std::size_t all = closures.size();
  std::vector<Edge> measured;
  std::vector<double> gaps;
  for (const Edge& edge : closures) {
    if (is_close(edge.from_from_to, Pose{}, kExact, kExact)) {
      gaps.push_back(gap_of(edge, chain).translation.norm());
    } else {
      measured.push_back(edge);
    }
  }
  const std::size_t count = gaps.size();
  const double gap = median_value(std::move(gaps));
  const bool are_few = static_cast<double>(count) < kLeastPart * static_cast<double>(all);
  if (count < kFewest || are_few || gap < kLeastGap) return std::nullopt;
  closures = std::move(measured);
  return InputFinding{
      Fault::closure_gap,
      fmt::format("{} of {} closures state exactly the same pose at both ends, where the odometry "
                  "has a median distance of {:.3g} m: the poses were not measured",
                  count,
                  all,
                  gap),
      "measure the relative poses (registration), or state their information for positions only",
      0.7,
      static_cast<double>(count)};
}

std::optional<InputFinding> find_closure_repair(const Problem& problem, const Chain& chain) {
  constexpr double kLeastChosen = 5.0, kLeastProven = 3.0;  // in logarithms of the likelihood
  constexpr double kMostRatio = 0.9, kMostOfUnit = 0.3;     // shrinking removes noise, too
  constexpr double kMostGrowth = 1.1, kMostLeft = 0.9;      // [-], [rad]
  constexpr std::size_t kFewestForHalves = 6;               // fewer groups differ little by chance
  const std::vector<LoopGroup> groups = loop_groups(problem.closures, chain);
  std::vector<const LoopGroup*> chosen, tested;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const bool is_half = groups.size() >= kFewestForHalves;
    if (!is_half || i % 2 == 0) chosen.push_back(&groups[i]);
    if (!is_half || i % 2 == 1) tested.push_back(&groups[i]);
  }
  static const std::vector<EdgeRepair> all = candidates();
  // Compared with the best so far: against the file as read, several reach the limit of gain().
  const EdgeRepair* best = &kAsRead;
  std::vector<LoopFit> best_fits = fits(chosen, chain, kAsRead);
  for (const EdgeRepair& repair : all) {
    std::vector<LoopFit> found = fits(chosen, chain, repair);
    const double least = (best->fault == repair.fault ? 0.0 : kLeastChosen) - best->penalty;
    if (!(gain(best_fits, found) - repair.penalty > least)) continue;
    best_fits = std::move(found);
    best = &repair;
  }
  if (best == &kAsRead) return std::nullopt;
  const std::vector<LoopFit> was = fits(tested, chain, kAsRead);
  const std::vector<LoopFit> is = fits(tested, chain, *best);
  const double proven = gain(was, is);
  const bool is_unit = best->fault == Fault::closure_unit;
  const double metres = median_error(was, &LoopFit::metres);
  const double radians = median_error(was, &LoopFit::radians);
  const double metres_after = median_error(is, &LoopFit::metres);
  const double radians_after = median_error(is, &LoopFit::radians);
  const auto [smaller, larger] = std::minmax({metres_after / metres, radians_after / radians});
  const double ratio = is_unit ? metres_after / metres : smaller;
  if (proven < kLeastProven || ratio > (is_unit ? kMostOfUnit : kMostRatio) ||
      larger > kMostGrowth || radians_after > kMostLeft) {
    return std::nullopt;
  }
  return InputFinding{
      best->fault,
      fmt::format("{}: error with which odometry and other closures predict a closure {:.3g} -> "
                  "{:.3g} m, {:.3g} -> {:.3g} deg (logarithm of the ratio of likelihoods {:.1f})",
                  best->what,
                  metres,
                  metres_after,
                  kDegrees * radians,
                  kDegrees * radians_after,
                  proven),
      best->fix,
      1.0 - std::exp(-0.25 * proven),
      static_cast<double>(problem.closures.size())};
}

}  // namespace loopbench::metrics
