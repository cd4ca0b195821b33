#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "metrics/doctor/pair_checks.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::metrics {
namespace {

double duration(const Trajectory& poses) { return poses.back().stamp - poses.front().stamp; }

/// Length of the common range [s]; negative: the distance between the ranges.
double overlap(const Trajectory& a, const Trajectory& b) {
  return std::min(a.back().stamp, b.back().stamp) - std::max(a.front().stamp, b.front().stamp);
}

bool has_frame_indices(const Trajectory& poses) {
  constexpr double kRounding = 1e-6, kMostFirst = 1000.0;
  constexpr double kMostStep = 20.0;  // keyframes skip frames
  const double first = poses.front().stamp;
  if (first < 0.0 || first > kMostFirst || usual_interval(poses) > kMostStep) return false;
  return std::ranges::all_of(poses, [&](const StampedPose& pose) {
    return std::abs(pose.stamp - std::round(pose.stamp)) < kRounding;
  });
}

Trajectory restamped(Trajectory poses, double factor, double offset) {
  for (StampedPose& pose : poses) pose.stamp = factor * pose.stamp + offset;
  return poses;
}

}  // namespace

std::optional<InputFinding> repair_stamp_unit(Trajectory& reference, Trajectory& estimate) {
  constexpr double kHardly = 0.01, kMostly = 0.5, kLeastPart = 0.05;
  if (reference.size() < 2 || estimate.size() < 2) return std::nullopt;
  const double longest = std::max(duration(reference), duration(estimate));
  if (overlap(reference, estimate) > kHardly * longest) return std::nullopt;
  for (const auto& [factor, unit] : {std::pair{1e-3, "milliseconds"},
                                     std::pair{1e-6, "microseconds"},
                                     std::pair{1e-9, "nanoseconds"}}) {
    for (const bool is_reference : {false, true}) {
      Trajectory& wrong = is_reference ? reference : estimate;
      Trajectory changed = restamped(wrong, factor, 0.0);
      const Trajectory& other = is_reference ? estimate : reference;
      const auto [shorter, longer] = std::minmax({duration(changed), duration(other)});
      const double common = overlap(changed, other);
      if (shorter < kLeastPart * longer || common < kMostly * shorter) continue;
      wrong = std::move(changed);
      return InputFinding{
          Fault::stamp_unit,
          fmt::format("the stamps of the {} are {}: with seconds, {:.1f} s are common",
                      is_reference ? "reference" : "estimate",
                      unit,
                      common),
          fmt::format("traj transform {} --stamp-scale {:g}", is_reference ? "REF" : "EST", factor),
          1.0,
          is_reference ? factor : 1.0 / factor};
    }
  }
  return std::nullopt;
}

std::optional<InputFinding> repair_frame_indices(const Trajectory& reference,
                                                 Trajectory& estimate) {
  constexpr double kAgrees = 0.7;  // correlation of speeds
  if (reference.size() < kFewestCommonPoses || estimate.size() < kFewestCommonPoses ||
      !has_frame_indices(estimate) || has_frame_indices(reference)) {
    return std::nullopt;
  }
  const double as_read = speed_correlation(reference, estimate);
  if (as_read > kAgrees) return std::nullopt;
  double best = kAgrees, factor = 0.0, offset = 0.0;
  const double longest = duration(reference);
  std::vector<double> intervals{longest / duration(estimate)};
  for (const double rate : {5, 10, 15, 20, 25, 30, 50, 60, 100, 200}) {
    const double length = duration(estimate) / rate;
    if (length > 0.3 * longest && length < 1.5 * longest) intervals.push_back(1.0 / rate);
  }
  for (const double interval : intervals) {
    const double begin = reference.front().stamp - interval * estimate.front().stamp;
    const auto found =
        estimate_time_offset(reference, restamped(estimate, interval, begin), 0.5 * longest);
    if (!found || !(found->correlation > best)) continue;
    best = found->correlation;
    factor = interval;
    offset = begin + found->offset;
  }
  if (factor == 0.0) return std::nullopt;
  estimate = restamped(std::move(estimate), factor, offset);
  return InputFinding{
      Fault::frame_indices,
      fmt::format("the estimate's stamps are frame indices: with {:.4g} s per frame, correlation "
                  "of speeds {:.2f} -> {:.2f}",
                  factor,
                  as_read,
                  best),
      fmt::format("traj transform EST --stamp-scale {:.6g}, then --offset {:.4f}", factor, offset),
      best,
      factor};
}

std::optional<InputFinding> repair_clock_drift(const Trajectory& reference, Trajectory& estimate) {
  constexpr double kLeast = 0.015, kOfInterval = 0.1, kDeviations = 3.0;  // of the change [s]
  constexpr double kLeastRate = 5e-4;  // clocks of computers differ by 1e-4 at most
  constexpr double kMostRate = 0.01, kOfChange = 0.3;
  constexpr double kMostOfRotation = 0.98, kMostOfPosition = 0.5;  // of the error before
  constexpr std::size_t kParts = 3;
  const std::size_t n = estimate.size();
  if (n < kParts * kFewestCommonPoses) return std::nullopt;
  const double origin = estimate.front().stamp;
  const double searched = std::max(1.0, kMostRate * duration(estimate));
  std::array<TimeOffset, kParts> found;
  std::array<double, kParts> centres{};
  for (std::size_t i = 0; i < kParts; ++i) {
    const auto at = [&](std::size_t part) {
      return estimate.begin() + static_cast<std::ptrdiff_t>(part * n / kParts);
    };
    const Trajectory third(at(i), at(i + 1));
    const auto offset = estimate_time_offset(reference, third, searched);
    if (!offset || !offset->has_common_time) return std::nullopt;
    found[i] = *offset;
    centres[i] = 0.5 * (third.front().stamp + third.back().stamp);
  }
  const double change = found[2].offset - found[0].offset;
  const double rate = change / (centres[2] - centres[0]);
  const auto drifted = [&](double stamp) { return found[0].offset + rate * (stamp - centres[0]); };
  const double error = std::abs(found[1].offset - drifted(centres[1]));
  const double deviation = std::hypot(found[0].deviation, found[2].deviation);
  if (std::abs(change) <
          std::max({kLeast, kOfInterval * usual_interval(estimate), kDeviations * deviation}) ||
      std::abs(rate) < kLeastRate || std::abs(rate) > kMostRate ||
      error > kOfChange * std::abs(change)) {
    return std::nullopt;
  }
  Trajectory corrected = restamped(estimate, 1.0 + rate, drifted(0.0));
  const Agreement before = agreement(common_poses(reference, estimate, found[1].offset));
  const Agreement after = agreement(common_poses(reference, corrected));
  const bool by_rotation = before.has_rotations;
  const double was = by_rotation ? 100.0 * before.turning : before.similarity;
  const double is = by_rotation ? 100.0 * after.turning : after.similarity;
  if (!(is < (by_rotation ? kMostOfRotation : kMostOfPosition) * was)) return std::nullopt;
  estimate = std::move(corrected);
  return InputFinding{
      Fault::clock_drift,
      fmt::format("the estimate's clock drifts by {:.3f} %: its offset grows from {:.3f} to "
                  "{:.3f} s; {} {:.3g} -> {:.3g} {}",
                  100.0 * rate,
                  found[0].offset,
                  found[2].offset,
                  by_rotation ? "error of relative rotations" : "position error",
                  was,
                  is,
                  by_rotation ? "%" : "m"),
      fmt::format(
          "correct its stamps t: t + {:.4f} + {:.6f} (t - {:.3f})", drifted(origin), rate, origin),
      1.0 - error / std::abs(change),
      rate};
}

std::optional<InputFinding> check_overlap(const Trajectory& reference, const Trajectory& estimate) {
  if (reference.empty() || estimate.empty()) return std::nullopt;
  const double distance = -overlap(reference, estimate);
  if (!(distance > 0.0)) return std::nullopt;
  const bool has_indices = has_frame_indices(estimate) && !has_frame_indices(reference);
  return InputFinding{has_indices ? Fault::frame_indices : Fault::no_overlap,
                      fmt::format("the estimate's stamps ({:.3f} to {:.3f}) and the reference's "
                                  "({:.3f} to {:.3f}) have no common time",
                                  estimate.front().stamp,
                                  estimate.back().stamp,
                                  reference.front().stamp,
                                  reference.back().stamp),
                      has_indices ? "write the estimate's stamps in seconds"
                                  : "give files of the same recording, or the offset (--offset)",
                      1.0,
                      distance};
}

std::optional<InputFinding> check_missing(const Trajectory& reference, const Trajectory& estimate) {
  constexpr double kLeastShare = 0.25, kLeastGap = 2.0;  // [-], [s]
  if (std::min(reference.size(), estimate.size()) < kFewestCommonPoses) return std::nullopt;
  std::vector<double> covered = stamps(estimate);
  covered.insert(covered.end(), {reference.front().stamp, reference.back().stamp});
  std::ranges::sort(covered);
  TrackingGap longest;
  double missing = 0.0;  // [m]
  for (const TrackingGap& gap : tracking_gaps(reference, covered, 0.0, kLeastGap)) {
    Trajectory inside;
    std::ranges::copy_if(reference, std::back_inserter(inside), [&](const StampedPose& pose) {
      return pose.stamp >= gap.begin && pose.stamp <= gap.end;
    });
    missing += path_length(inside);
    if (gap.end - gap.begin > longest.end - longest.begin) longest = gap;
  }
  const double all = path_length(reference);
  const double share = all > 0.0 ? missing / all : 0.0;
  if (share < kLeastShare) return std::nullopt;
  return InputFinding{
      Fault::missing_poses,
      fmt::format("the estimate has no poses for {:.0f} % of the reference's path; the longest "
                  "gap has {:.1f} s and begins at {:.3f}",
                  100.0 * share,
                  longest.end - longest.begin,
                  longest.begin),
      "errors hold for the covered part only: state the coverage, or run the system again",
      1.0,
      share};
}

}  // namespace loopbench::metrics
