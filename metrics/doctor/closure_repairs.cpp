#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "metrics/doctor/common_motion.hpp"
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

/// Translations of `edges` in millimetres or centimetres, or those of the other edges: what has to
/// be written in metres in these cases.
std::vector<EdgeRepair> unit_repairs(const std::string& edges,
                                     const std::string& if_larger,
                                     const std::string& if_smaller) {
  std::vector<EdgeRepair> out;
  for (const double factor : {0.001, 0.01, 100.0, 1000.0}) {
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
        "quaternions of the closures in the order w x y z",
        "write their quaternions as x y z w",
        [](const Pose& p, const Rotation&) -> Pose {
          const Rotation& q = p.rotation;
          return {Rotation(q.x(), q.y(), q.z(), q.w()), p.translation};
        }},
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
  for (const Matrix3& axes : signed_axes()) {
    if (axes.determinant() < 0.0) continue;
    const Rotation body(axes);
    out.push_back({Fault::closure_frame,
                   "taking " + axes_option(axes) + " of the closures' body as x,y,z",
                   "transform them into the odometry's body: C T C^-1 for each closure T",
                   [=](const Pose& p, const Rotation&) -> Pose {
                     return {body * p.rotation * body.conjugate(), body * p.translation};
                   },
                   std::log(24.0)});
  }
  return out;
}

/// Groups of up to five closures that follow each other, evenly chosen.
std::vector<LoopGroup> groups_of(const Problem& problem, const Chain& chain) {
  constexpr std::size_t kSize = 5, kMost = 14;
  std::vector<const Edge*> sorted;
  for (const Edge& edge : problem.closures) sorted.push_back(&edge);
  std::ranges::stable_sort(sorted, {}, [](const Edge* e) { return std::max(e->from, e->to); });
  const std::size_t n = sorted.size();
  std::vector<LoopGroup> out;
  const std::size_t count = std::clamp<std::size_t>((n + 1) / kSize, n < kSize + 1 ? 1 : 2, kMost);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * n / count;
    const std::size_t size = std::min({(i + 1) * n / count - begin, count == 1 ? n : kSize});
    out.emplace_back(
        std::vector<const Edge*>(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                                 sorted.begin() + static_cast<std::ptrdiff_t>(begin + size)),
        chain);
  }
  return out;
}

double log_likelihood(const LoopGroup& group,
                      const Chain& chain,
                      const EdgeRepair* repair,
                      PredictionError* errors = nullptr) {
  std::vector<Pose> measured;
  Rotation previous = Rotation::Identity();  // of the gap
  for (const Edge* edge : group.closures()) {
    const Rotation odometry = chain.between(edge->from, edge->to).rotation;
    const Pose& read = edge->from_from_to;
    measured.push_back(repair == nullptr ? read
                                         : repair->change(read, odometry * previous.conjugate()));
    previous = measured.back().rotation.conjugate() * odometry;
  }
  double out = group.log_likelihood(measured, errors);
  if (repair != nullptr) {
    out -= static_cast<double>(measured.size()) * repair->penalty_of_closure;
  }
  return out;
}

/// Choices and proofs use alternate groups; all, if there are few, which differ little by chance.
std::size_t step_of(const std::vector<LoopGroup>& groups) {
  constexpr std::size_t kFewestForHalves = 6;
  return groups.size() < kFewestForHalves ? 1 : 2;
}

/// Sum over every other group; one group, whose closures may be false, counts up to a limit.
double gain_of(const std::vector<LoopGroup>& groups,
               const std::vector<double>& as_read,
               const Chain& chain,
               const EdgeRepair& repair,
               std::size_t first,
               PredictionError* errors = nullptr) {
  constexpr double kMostOfGroup = 20.0;
  double out = 0.0;
  const std::size_t step = step_of(groups);
  for (std::size_t i = first % step; i < groups.size(); i += step) {
    out += std::clamp(log_likelihood(groups[i], chain, &repair, errors) - as_read[i],
                      -kMostOfGroup,
                      kMostOfGroup);
  }
  return out;
}

/// The error of predictions that a repair reduces most, as a ratio and as a text; that of positions
/// for units of translations.
std::pair<double, std::string> largest_change(const PredictionError& before,
                                              const PredictionError& after,
                                              bool is_unit) {
  const double metres = median_value(before.metres), radians = median_value(before.radians);
  const double metres_after = median_value(after.metres);
  const double radians_after = median_value(after.radians);
  const double of_metres = (metres_after + 1e-6) / (metres + 1e-6);
  const double of_radians = (radians_after + 1e-6) / (radians + 1e-6);
  const bool is_rotation = !is_unit && of_radians < of_metres;
  return {is_rotation ? of_radians : of_metres,
          fmt::format("error with which odometry and other closures predict a closure {:.3g} -> "
                      "{:.3g} {}",
                      is_rotation ? kDegrees * radians : metres,
                      is_rotation ? kDegrees * radians_after : metres_after,
                      is_rotation ? "deg" : "m")};
}

/// Median difference of the odometry and the keyframes, over the keyframes' median step [-].
double odometry_error(const Problem& problem, const EdgeChange& change) {
  std::vector<double> errors, steps;
  for (const Edge& edge : problem.odometry) {
    const Pose step = problem.keyframes[edge.from].world_from_body.inverse() *
                      problem.keyframes[edge.to].world_from_body;
    errors.push_back(
        (change(edge.from_from_to, step.rotation).translation - step.translation).norm());
    steps.push_back(step.translation.norm());
  }
  const double step = median_value(std::move(steps));
  return step > 0.0 ? median_value(std::move(errors)) / step : 0.0;
}

}  // namespace

std::optional<InputFinding> find_odometry_repair(const Problem& problem) {
  constexpr double kBad = 0.3, kBetter = 0.2;
  std::vector<EdgeRepair> all =
      unit_repairs("the odometry", "all edges and vertices", "all edges and vertices");
  all.push_back({Fault::odometry_direction,
                 "inverting the odometry",
                 "exchange the two vertices of each odometry edge",
                 inverted_edge});
  const double before = odometry_error(problem, unchanged_edge);
  if (before < kBad) return std::nullopt;
  for (const EdgeRepair& repair : all) {
    const double after = odometry_error(problem, repair.change);
    if (after > kBetter * before) continue;
    return InputFinding{repair.fault,
                        fmt::format("{}: difference to the vertices {:.3g} -> {:.3g} % of a step",
                                    repair.what,
                                    100.0 * before,
                                    100.0 * after),
                        repair.fix,
                        1.0 - after / before,
                        static_cast<double>(problem.odometry.size())};
  }
  return std::nullopt;
}

std::optional<InputFinding> find_closure_repair(const Problem& problem, const Chain& chain) {
  constexpr double kLeastChosen = 5.0, kLeastProven = 3.0;  // in logarithms of the likelihood
  constexpr double kMostRatio = 0.9, kMostOfUnit = 0.3;     // shrinking removes noise, too
  const std::vector<LoopGroup> groups = groups_of(problem, chain);
  static const std::vector<EdgeRepair> all = candidates();
  std::vector<double> as_read;
  PredictionError before;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const bool is_tested = i % 2 == 1 || step_of(groups) == 1;
    as_read.push_back(log_likelihood(groups[i], chain, nullptr, is_tested ? &before : nullptr));
  }
  const EdgeRepair* best = nullptr;
  double largest = kLeastChosen;
  for (const EdgeRepair& repair : all) {
    const double gain = gain_of(groups, as_read, chain, repair, 0) - repair.penalty;
    if (!(gain > largest)) continue;
    largest = gain;
    best = &repair;
  }
  if (best == nullptr) return std::nullopt;
  PredictionError after;
  const double proven = gain_of(groups, as_read, chain, *best, 1, &after);
  const bool is_unit = best->fault == Fault::closure_unit;
  const auto [ratio, text] = largest_change(before, after, is_unit);
  if (proven < kLeastProven || ratio > (is_unit ? kMostOfUnit : kMostRatio)) return std::nullopt;
  return InputFinding{
      best->fault,
      fmt::format(
          "{}: {} (logarithm of the ratio of likelihoods {:.1f})", best->what, text, proven),
      best->fix,
      1.0 - std::exp(-0.25 * proven),
      static_cast<double>(problem.closures.size())};
}

}  // namespace loopbench::metrics
