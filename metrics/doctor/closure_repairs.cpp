#include "metrics/doctor/closure_repairs.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

struct ClosureRepair {
  Fault fault{};
  std::string what;
  std::string fix;
  /// Changes a closure; the odometry predicts its rotation.
  std::function<void(Edge&, const Rotation&)> change;
  bool is_ambiguous = false;  ///< fits the odometry always, so that only neighbours can prove it
};

ClosureRepair of_measurement(Fault fault,
                             std::string what,
                             std::string fix,
                             const std::function<Pose(const Pose&)>& change) {
  return {fault, std::move(what), std::move(fix), [=](Edge& edge, const Rotation&) {
            edge.from_from_to = change(edge.from_from_to);
          }};
}

/// Angles in degrees that were read as radians are known up to full rotations: the one that is
/// closest to the odometry is taken.
void angles_to_radians(Edge& edge, const Rotation& predicted) {
  const Vector3 read = log_so3(edge.from_from_to.rotation);
  const double angle = read.norm();
  if (angle == 0.0) return;
  const Vector3 axis = read / angle;
  const double expected = kDegrees * log_so3(predicted).dot(axis);
  const double rotations = std::round((expected - angle) / (2.0 * M_PI));
  edge.from_from_to.rotation = exp_so3((angle + 2.0 * M_PI * rotations) / kDegrees * axis);
}

/// The rotations that map axes to axes, but for the identity.
std::vector<Rotation> axis_rotations() {
  std::vector<Rotation> out;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3 axes = Matrix3::Zero();
      for (int row = 0; row < 3; ++row) {
        axes(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1.0 : 1.0;
      }
      if (axes.determinant() > 0.0 && axes != Matrix3::Identity()) out.emplace_back(axes);
    }
  } while (std::ranges::next_permutation(order).found);
  return out;
}

std::vector<ClosureRepair> candidates() {
  const std::string columns = "in a file of loops the first two columns";
  std::vector<ClosureRepair> out{
      of_measurement(Fault::closure_direction,
                     "inverting the closures (or all odometry)",
                     "exchange the two vertices of each closure; " + columns,
                     [](const Pose& p) { return p.inverse(); }),
      of_measurement(Fault::closure_rotation,
                     "quaternions of the closures in the order w x y z",
                     "write their quaternions as x y z w",
                     [](const Pose& p) -> Pose {
                       const Rotation& q = p.rotation;
                       return {Rotation(q.x(), q.y(), q.z(), q.w()), p.translation};
                     }),
      of_measurement(Fault::closure_rotation,
                     "multiplying the closures' angles by 57.3",
                     "write their angles in radians, converted once",
                     [](const Pose& p) -> Pose {
                       return {exp_so3(kDegrees * log_so3(p.rotation)), p.translation};
                     }),
      {Fault::closure_rotation,
       "the closures' angles in degrees",
       "write their angles in radians",
       angles_to_radians,
       true}};
  for (const double factor : {0.001, 0.01, 100.0, 1000.0}) {
    out.push_back(of_measurement(
        Fault::closure_unit,
        fmt::format("multiplying the closures' translations by {:g}", factor),
        fmt::format("write {} in metres", factor < 1.0 ? "the closures" : "the odometry"),
        [=](const Pose& p) -> Pose {
          return {p.rotation, factor * p.translation};
        }));
  }
  for (const Rotation& body : axis_rotations()) {
    const Vector3 q = body.vec();
    out.push_back(
        of_measurement(Fault::closure_frame,
                       fmt::format("rotating the closures' body by quaternion {:g} {:g} {:g} {:g}",
                                   q.x(),
                                   q.y(),
                                   q.z(),
                                   body.w()),
                       "transform them into the odometry's body: C T C^-1 for each closure T",
                       [=](const Pose& p) -> Pose {
                         return {body * p.rotation * body.conjugate(), body * p.translation};
                       }));
  }
  return out;
}

/// Median errors of closures: over whole loops, and against a neighbour.
struct ClosureErrors {
  double drift = 0.0;          ///< gap over the length of the loop [-]
  double loop_rotation = 0.0;  ///< [rad]
  double near = 0.0;           ///< difference over the length of the path between both [-]
  double near_metres = 0.0;    ///< [m]
  double near_rotation = 0.0;  ///< [rad]
  std::size_t pairs = 0;

  double cost() const {
    double out = std::log(drift + 0.01) + std::log(loop_rotation + 0.02);
    if (pairs > 0) out += std::log(near + 0.003) + std::log(near_rotation + 0.003);
    return out;
  }
};

/// Of every `step`-th closure and pair from `first` on.
ClosureErrors errors_of(const std::vector<Edge>& closures,
                        const std::vector<Neighbours>& neighbours,
                        const Chain& chain,
                        std::size_t first,
                        std::size_t step) {
  std::vector<double> drifts, angles, differences, metres, near_angles;
  for (std::size_t i = first; i < closures.size(); i += step) {
    const Edge& edge = closures[i];
    drifts.push_back(drift_of(edge, chain));
    angles.push_back(
        angle_between(edge.from_from_to.rotation, chain.between(edge.from, edge.to).rotation));
  }
  for (std::size_t i = first; i < neighbours.size(); i += step) {
    const auto& [a, b] = neighbours[i];
    const Twist residual = neighbour_residual(neighbours[i], chain, false);
    const double length = chain.length(a->from, b->from) + chain.length(a->to, b->to);
    metres.push_back(residual.head<3>().norm());
    differences.push_back(metres.back() / std::max(1e-6, length));
    near_angles.push_back(residual.tail<3>().norm());
  }
  return {median_value(std::move(drifts)),
          median_value(std::move(angles)),
          median_value(std::move(differences)),
          median_value(std::move(metres)),
          median_value(std::move(near_angles)),
          metres.size()};
}

/// The error that a repair reduces most, and its ratio.
std::pair<double, std::string> largest_change(const ClosureErrors& before,
                                              const ClosureErrors& after) {
  std::pair<double, std::string> out{1.0, ""};
  const auto compare = [&](double was, double is, double floor, const std::string& text) {
    const double ratio = (is + floor) / (was + floor);
    if (ratio < out.first) out = {ratio, text};
  };
  if (before.pairs > 0) {
    compare(before.near,
            after.near,
            0.003,
            fmt::format("difference of neighbouring closures {:.3g} -> {:.3g} m",
                        before.near_metres,
                        after.near_metres));
    compare(before.near_rotation,
            after.near_rotation,
            0.002,
            fmt::format("difference of neighbouring closures {:.3g} -> {:.3g} deg",
                        kDegrees * before.near_rotation,
                        kDegrees * after.near_rotation));
  }
  compare(before.drift,
          after.drift,
          0.003,
          fmt::format("gaps of loops {:.3g} -> {:.3g} % of their length",
                      100.0 * before.drift,
                      100.0 * after.drift));
  compare(before.loop_rotation,
          after.loop_rotation,
          0.01,
          fmt::format("rotation of loops against the odometry {:.3g} -> {:.3g} deg",
                      kDegrees * before.loop_rotation,
                      kDegrees * after.loop_rotation));
  return out;
}

/// Errors of closures with even (0) and odd (1) index after a repair; of all, if `has_halves` is
/// false.
std::array<ClosureErrors, 2> errors_after(const Problem& problem,
                                          const Chain& chain,
                                          const ClosureRepair* repair,
                                          bool has_halves) {
  std::vector<Edge> closures = problem.closures;
  for (Edge& edge : closures) {
    if (repair != nullptr) repair->change(edge, chain.between(edge.from, edge.to).rotation);
  }
  const std::vector<Neighbours> neighbours = neighbours_of(closures, chain);
  if (!has_halves) {
    const ClosureErrors errors = errors_of(closures, neighbours, chain, 0, 1);
    return {errors, errors};
  }
  return {errors_of(closures, neighbours, chain, 0, 2),
          errors_of(closures, neighbours, chain, 1, 2)};
}

/// Rotations of neighbouring closures after an ambiguous repair: of wrong ones, they would differ
/// by more than 1.5 deg, half of the largest distance to a full rotation in degrees.
bool agrees_with_neighbours(const ClosureErrors& before, const ClosureErrors& after) {
  constexpr double kMost = 1.0 / kDegrees, kOfBefore = 0.2;
  return after.pairs >= 2 &&
         after.near_rotation < std::min(kMost, kOfBefore * before.near_rotation);
}

}  // namespace

std::optional<InputFinding> find_closure_repair(const Problem& problem) {
  constexpr double kLeastGain = 0.6, kMostRatio = 0.5;
  constexpr std::size_t kFewest = 3, kFewestForHalves = 16;
  if (problem.closures.size() < kFewest) return std::nullopt;
  static const std::vector<ClosureRepair> all = candidates();
  const Chain chain = chain_of(problem);
  const bool has_halves = problem.closures.size() >= kFewestForHalves;
  const auto before = errors_after(problem, chain, nullptr, has_halves);
  std::optional<InputFinding> out;
  double best = kLeastGain;
  for (const ClosureRepair& repair : all) {
    const auto after = errors_after(problem, chain, &repair, has_halves);
    const double gain = before[0].cost() - after[0].cost();
    if (!(gain > best)) continue;
    if (repair.is_ambiguous && !agrees_with_neighbours(before[1], after[1])) continue;
    const auto [ratio, text] = largest_change(before[1], after[1]);
    if (ratio > kMostRatio || before[1].cost() - after[1].cost() < kLeastGain) continue;
    best = gain;
    out = InputFinding{repair.fault,
                       repair.what + ": " + text,
                       repair.fix,
                       1.0 - ratio,
                       static_cast<double>(problem.closures.size())};
  }
  return out;
}

}  // namespace loopbench::metrics
