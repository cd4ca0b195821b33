#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "metrics/doctor/clock.hpp"
#include "metrics/doctor/pair_checks.hpp"

namespace loopbench::metrics {
namespace {

/// Poses at least 0.4 s apart.
Trajectory thinned(const Trajectory& poses) {
  constexpr double kLeast = 0.4;  // [s]
  Trajectory out;
  for (const StampedPose& pose : poses) {
    if (out.empty() || pose.stamp - out.back().stamp >= kLeast) out.push_back(pose);
  }
  return out;
}

/// Mean angular speed at intervals of about 0.5 s [rad/s], or linear speed without rotations [m/s].
double mean_speed(const Trajectory& poses) {
  const Trajectory few = thinned(poses);
  double angle = 0.0;
  for (std::size_t i = 1; i < few.size(); ++i) {
    angle += angle_between(few[i - 1].world_from_body.rotation, few[i].world_from_body.rotation);
  }
  return (angle > kLeastRotation ? angle : path_length(few)) / duration(few);
}

}  // namespace

std::optional<InputFinding> repair_rate(const Trajectory& reference,
                                        Trajectory& estimate,
                                        bool has_stamps) {
  constexpr double kAgrees = 0.7, kAgreesOfClocks = 0.85;  // correlation of speeds
  constexpr double kGain = 0.05, kFits = 0.4;  // over the same rate; of the reference's spread
  constexpr double kLeastChange = 0.07;        // smaller ones are those of drifting clocks
  if (std::min(reference.size(), estimate.size()) < kFewestCommonPoses) return std::nullopt;
  const bool has_indices =
      !has_stamps || (has_frame_indices(estimate) && !has_frame_indices(reference));
  const double as_read = speed_correlation(reference, estimate);
  const bool has_other_clock = !has_indices && overlap(reference, estimate) <= 0.0;
  if (as_read > kAgrees || has_other_clock) return std::nullopt;
  const double longest = duration(reference), ratio = longest / duration(estimate);
  const double searched = std::min(0.5 * longest, 60.0);  // [s]
  std::vector<double> factors{std::round(ratio)};
  if (has_stamps) factors.push_back(ratio);
  for (const double rate : {5, 10, 15, 20, 25, 30, 50, 60, 100, 200}) {
    if (has_stamps && has_indices) factors.push_back(1.0 / rate);
  }
  const bool is_any_rate = has_stamps && !has_indices;
  if (is_any_rate) {
    const double usual = mean_speed(estimate) / mean_speed(reference);
    for (int percent = -25; percent <= 25; ++percent) {
      factors.push_back(usual * (1.0 + 0.01 * percent));
    }
  }
  const Trajectory compared = is_any_rate ? thinned(estimate) : estimate;
  const auto same = estimate_time_offset(reference, compared);
  const double least =
      std::max(has_indices ? kAgrees : kAgreesOfClocks, same ? same->correlation + kGain : 0.0);
  double best = 0.0;
  double factor = 0.0, offset = 0.0;
  const auto attempt = [&](double each) {
    const double length = each * duration(estimate);
    const bool is_possible = length >= 0.3 * longest && length <= 1.5 * longest;  // and no NaN
    if (!is_possible || (is_any_rate && std::abs(each - 1.0) < kLeastChange)) return;
    const double begin = reference.front().stamp - each * estimate.front().stamp;
    const auto found = estimate_time_offset(reference, restamped(compared, each, begin), searched);
    if (!found || !(found->correlation > best)) return;
    best = found->correlation;
    factor = each;
    offset = begin + found->offset;
  };
  std::ranges::for_each(factors, attempt);
  if (is_any_rate) {
    const double coarse = factor;
    for (const double change : {-0.8, -0.6, -0.4, -0.2, 0.2, 0.4, 0.6, 0.8}) {
      attempt(coarse * (1.0 + 0.01 * change));
    }
  }
  if (best < least) return std::nullopt;
  Trajectory corrected = restamped(estimate, factor, offset);
  const Agreement after = agreement(common_poses(reference, corrected));
  if (after.similarity > kFits * after.spread) return std::nullopt;
  estimate = std::move(corrected);
  return InputFinding{
      has_indices ? Fault::frame_indices : Fault::clock_drift,
      fmt::format("the estimate's stamps {}: with {:.4g} s per {}, correlation of speeds {:.2f} -> "
                  "{:.2f}",
                  has_indices ? "are frame indices" : "grow at another rate",
                  factor,
                  has_indices ? "frame" : "second",
                  as_read,
                  best),
      stamps_command(factor, offset),
      best,
      factor};
}

}  // namespace loopbench::metrics
