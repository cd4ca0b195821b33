#include "metrics/pairing/pairs/stretch.hpp"

#include <cmath>

#include "metrics/numerics/angle.hpp"
#include "metrics/pairing/motion.hpp"
#include "metrics/pairing/pairs/angle_pairs.hpp"
#include "metrics/pairing/pairs/consecutive.hpp"

namespace loopbench::metrics {
namespace {

/// A whole number of frames; nullopt if no list can be that long.
std::size_t frames(const PairDelta& stretch, std::size_t size) {
  check(stretch);
  return static_cast<std::size_t>(std::min(stretch.delta, static_cast<double>(size)));
}

double radians(const PairDelta& stretch) {
  check(stretch);
  return stretch.unit == DeltaUnit::deg ? stretch.delta / kDegrees : stretch.delta;
}

std::vector<double> step_lengths(const Trajectory& poses) {
  std::vector<double> out(poses.size());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    out[i] =
        (poses[i].world_from_body.translation - poses[i - 1].world_from_body.translation).norm();
  }
  return out;
}

}  // namespace

void check(const PairDelta& stretch) {
  const double delta = stretch.delta;
  const auto refuse = [&](const std::string& why) {
    return OptionError("delta", "delta = " + to_text(delta) + ": " + why);
  };
  if (stretch.unit == DeltaUnit::frames && delta != std::floor(delta)) {
    throw refuse("expected a whole number of frames");
  }
  const bool is_angle = stretch.unit == DeltaUnit::deg || stretch.unit == DeltaUnit::rad;
  const double angle = stretch.unit == DeltaUnit::deg ? delta / kDegrees : delta;
  if (is_angle && angle > std::numbers::pi) throw refuse("expected at most 180 degrees");
}

std::vector<double> rotation_angles(const Trajectory& trajectory, AngleFormula formula) {
  std::vector<double> out(trajectory.size());
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    out[i] = rotation_angle(formula,
                            trajectory[i - 1].world_from_body.rotation.conjugate() *
                                trajectory[i].world_from_body.rotation);
  }
  return out;
}

std::vector<FromTo> select_pairs(const Trajectory& reference,
                                 const Trajectory& measured,
                                 PairRule rule,
                                 const PairDelta& stretch) {
  const bool is_all = rule == PairRule::all;
  const double delta = stretch.delta;
  switch (stretch.unit) {
    case DeltaUnit::frames: {
      const std::size_t n = reference.size();
      const std::size_t d = frames(stretch, n);
      return is_all ? pairs_by_frames(n, d) : consecutive_frames(n, d);
    }
    case DeltaUnit::s:
      if (is_all) return pairs_by_measure(stamps(reference), delta, stretch.tolerance * delta);
      return consecutive_seconds(stamps(reference), delta, stretch.tolerance * delta);
    case DeltaUnit::m:
      if (is_all) {
        return pairs_by_measure(accumulated_distances(measured), delta, stretch.tolerance * delta);
      }
      return consecutive_by_measure(step_lengths(measured), delta, FirstPose::left_out);
    case DeltaUnit::deg:
    case DeltaUnit::rad:
      break;
  }
  const double angle = radians(stretch);
  if (is_all) return angle_pairs(measured, angle, stretch.tolerance * angle);
  return consecutive_by_measure(
      rotation_angles(measured, AngleFormula::rotation_vector), angle, FirstPose::starts);
}

}  // namespace loopbench::metrics
