#include "metrics/doctor/unit_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/frame_fit.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kMostUnitPoses = 2000;

/// Median ratio of rotation angles over short intervals, without wraps.
double angle_ratio(const CommonPoses& poses) {
  constexpr double kLeast = 0.05 / kDegrees, kMost = 2.5 / kDegrees;
  std::vector<double> ratios;
  for (std::size_t i = 1; i < poses.stamps.size(); ++i) {
    const auto angle = [&](const std::vector<Pose>& list) {
      return angle_between(list[i - 1].rotation, list[i].rotation);
    };
    const double reference = angle(poses.reference);
    const double estimate = angle(poses.estimate);
    const double smaller = std::min(reference, estimate);
    if (smaller < kLeast || smaller > kMost) continue;
    ratios.push_back(estimate / reference);
  }
  return ratios.size() < 8 ? 1.0 : median_value(std::move(ratios));
}

/// Median ratio of rotation angles over intervals in which the reference rotates by 5 to 60 deg.
double ratio_of_larger_angles(const CommonPoses& poses) {
  constexpr double kLeast = 5.0 / kDegrees, kMost = 60.0 / kDegrees;
  std::vector<double> ratios;
  std::size_t from = 0;
  for (std::size_t to = 1; to < poses.stamps.size(); ++to) {
    const auto angle = [&](const std::vector<Pose>& list) {
      return angle_between(list[from].rotation, list[to].rotation);
    };
    const double reference = angle(poses.reference);
    if (reference < kLeast) continue;
    if (reference <= kMost) ratios.push_back(angle(poses.estimate) / reference);
    from = to;
  }
  return ratios.size() < 8 ? 1.0 : median_value(std::move(ratios));
}

std::optional<InputFinding> check_scale(const PositionFit& fit) {
  constexpr double kUnitTolerance = 0.12, kLeastScale = 0.1, kBetter = 0.5, kGood = 0.35;
  if (fit.similarity > kGood || !(fit.scale > 0.0)) return std::nullopt;
  for (const double unit : {1000.0, 100.0, 0.01, 0.001}) {
    if (std::abs(std::log(fit.scale * unit)) > kUnitTolerance) continue;
    return InputFinding{
        Fault::length_unit,
        fmt::format("distances in the estimate are {:.4g} times those of the reference",
                    1.0 / fit.scale),
        fmt::format("traj transform {} --scale {} ({} to metres)",
                    unit > 1.0 ? "EST" : "REF",
                    unit == 1000.0 || unit == 0.001 ? "0.001" : "0.01",
                    unit == 1000.0 || unit == 0.001 ? "millimetres" : "centimetres"),
        1.0 - fit.similarity,
        1.0 / fit.scale};
  }
  const bool is_scaled = std::abs(std::log(fit.scale)) > kLeastScale;
  if (!is_scaled || fit.similarity > kBetter * fit.rigid) return std::nullopt;
  return InputFinding{
      Fault::scale,
      fmt::format("the estimate has scale {:.3f}: with --align sim3, {:.3g} m becomes "
                  "{:.3g} m",
                  1.0 / fit.scale,
                  fit.rmse_rigid,
                  fit.rmse_similarity),
      "--align sim3",
      1.0 - fit.similarity / fit.rigid,
      fit.scale};
}

}  // namespace

std::optional<InputFinding> check_angle_unit(const CommonPoses& poses) {
  const auto lacks = [](const std::vector<Pose>& all) {
    return all.empty() || !has_rotation(all.front());
  };
  if (lacks(poses.reference) || lacks(poses.estimate)) return std::nullopt;
  const double of_larger = ratio_of_larger_angles(poses);
  const double ratio = of_larger < 0.1 ? of_larger : angle_ratio(poses);
  constexpr double kFactor = kDegrees, kTolerance = 2.2;
  const bool is_large = ratio > kFactor / kTolerance && ratio < kFactor * kTolerance;
  const bool is_small = ratio < kTolerance / kFactor && ratio > 1.0 / (kFactor * kTolerance);
  if (!is_large && !is_small) return std::nullopt;
  return InputFinding{
      Fault::angle_unit,
      fmt::format("the estimate rotates {:.3g} times as much as the reference", ratio),
      fmt::format(
          "{} were used as {} in the estimate, or the reverse in the reference: convert that "
          "file's source again, or use position errors only (eval -r trans_part)",
          is_large ? "degrees" : "radians",
          is_large ? "radians" : "degrees"),
      0.9,
      ratio};
}

std::vector<InputFinding> check_units(const Trajectory& reference, const Trajectory& estimate) {
  std::vector<InputFinding> out;
  const CommonPoses poses = common_poses(reference, estimate, 0.0, kMostUnitPoses);
  if (poses.stamps.size() < kFewestUnitPoses) return out;
  if (auto finding = check_angle_unit(poses)) out.push_back(*finding);
  if (auto finding = check_scale(fit_positions(poses.reference, poses.estimate))) {
    out.push_back(*finding);
  }
  return out;
}

}  // namespace loopbench::metrics
