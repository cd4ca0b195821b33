#include "metrics/pairing/select_pairs.hpp"

#include <cmath>

#include "metrics/numerics/angle.hpp"
#include "metrics/pairing/motion.hpp"
#include "metrics/pairing/pair_search.hpp"

namespace loopbench::metrics {
namespace {

/// A whole number of frames; nullopt if no list can be that long.
std::size_t frames(const PairDelta& pair_delta, std::size_t size) {
  check(pair_delta);
  return static_cast<std::size_t>(std::min(pair_delta.delta, static_cast<double>(size)));
}

double radians(const PairDelta& pair_delta) {
  check(pair_delta);
  return pair_delta.unit == DeltaUnit::deg ? pair_delta.delta / kDegrees : pair_delta.delta;
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

void check(const PairDelta& pair_delta) {
  const double delta = pair_delta.delta;
  const auto refuse = [&](const std::string& why) {
    return OptionError("delta", "delta = " + to_text(delta) + ": " + why);
  };
  if (pair_delta.unit == DeltaUnit::frames && delta != std::floor(delta)) {
    throw refuse("expected a whole number of frames");
  }
  const bool is_angle = pair_delta.unit == DeltaUnit::deg || pair_delta.unit == DeltaUnit::rad;
  const double angle = pair_delta.unit == DeltaUnit::deg ? delta / kDegrees : delta;
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
                                 const PairDelta& pair_delta) {
  const bool is_all = rule == PairRule::all;
  const double delta = pair_delta.delta;
  switch (pair_delta.unit) {
    case DeltaUnit::frames: {
      const std::size_t n = reference.size();
      const std::size_t d = frames(pair_delta, n);
      return is_all ? pairs_by_frames(n, d) : consecutive_frames(n, d);
    }
    case DeltaUnit::s:
      if (is_all) return pairs_by_measure(stamps(reference), delta, pair_delta.tolerance * delta);
      return consecutive_seconds(stamps(reference), delta, pair_delta.tolerance * delta);
    case DeltaUnit::m:
      if (is_all) {
        return pairs_by_measure(
            accumulated_distances(measured), delta, pair_delta.tolerance * delta);
      }
      return consecutive_by_measure(step_lengths(measured), delta, FirstPose::left_out);
    case DeltaUnit::deg:
    case DeltaUnit::rad:
      break;
  }
  const double angle = radians(pair_delta);
  if (is_all) return angle_pairs(measured, angle, pair_delta.tolerance * angle);
  return consecutive_by_measure(
      rotation_angles(measured, AngleFormula::rotation_vector), angle, FirstPose::starts);
}

}  // namespace loopbench::metrics
