#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/time_offset.hpp"

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

}  // namespace

Trajectory restamped(Trajectory poses, double factor, double offset) {
  for (StampedPose& pose : poses) pose.stamp = factor * pose.stamp + offset;
  return poses;
}

std::optional<StampRepair> check_stamp_unit(const Trajectory& reference,
                                            const Trajectory& estimate) {
  constexpr double kHardly = 0.01, kMostly = 0.5, kLeastPart = 0.05;
  if (reference.size() < 2 || estimate.size() < 2) return std::nullopt;
  const double longer = std::max(duration(reference), duration(estimate));
  if (overlap(reference, estimate) > kHardly * longer) return std::nullopt;
  for (const auto& [factor, unit] : {std::pair{1e-3, "milliseconds"},
                                     std::pair{1e-6, "microseconds"},
                                     std::pair{1e-9, "nanoseconds"}}) {
    for (const bool is_reference : {false, true}) {
      const Trajectory a = restamped(reference, is_reference ? factor : 1.0, 0.0);
      const Trajectory b = restamped(estimate, is_reference ? 1.0 : factor, 0.0);
      const auto [shorter, other] = std::minmax({duration(a), duration(b)});
      if (shorter < kLeastPart * other || overlap(a, b) < kMostly * shorter) continue;
      return StampRepair{
          {Fault::stamp_unit,
           fmt::format("the stamps of the {} are {}: with seconds, {:.1f} s are common",
                       is_reference ? "reference" : "estimate",
                       unit,
                       overlap(a, b)),
           fmt::format(
               "traj transform {} --stamp-scale {:g}", is_reference ? "REF" : "EST", factor),
           1.0,
           is_reference ? factor : 1.0 / factor},
          factor,
          0.0,
          is_reference};
    }
  }
  return std::nullopt;
}

std::optional<StampRepair> check_frame_indices(const Trajectory& reference,
                                               const Trajectory& estimate) {
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
  return StampRepair{
      {Fault::frame_indices,
       fmt::format("the estimate's stamps are frame indices: with {:.4g} s per frame, correlation "
                   "of speeds {:.2f} -> {:.2f}",
                   factor,
                   as_read,
                   best),
       fmt::format("traj transform EST --stamp-scale {:.6g}, then --offset {:.4f}", factor, offset),
       best,
       factor},
      factor,
      offset};
}

std::optional<StampRepair> check_clock_drift(const Trajectory& reference,
                                             const Trajectory& estimate) {
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
  const Trajectory corrected = restamped(estimate, 1.0 + rate, drifted(0.0));
  const Agreement before = agreement(common_poses(reference, estimate, found[1].offset));
  const Agreement after = agreement(common_poses(reference, corrected));
  const bool by_rotation = before.has_rotations;
  const double was = by_rotation ? 100.0 * before.turning : before.similarity;
  const double is = by_rotation ? 100.0 * after.turning : after.similarity;
  if (!(is < (by_rotation ? kMostOfRotation : kMostOfPosition) * was)) return std::nullopt;
  return StampRepair{
      {Fault::clock_drift,
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
       rate},
      1.0 + rate,
      drifted(0.0)};
}

std::optional<InputFinding> check_overlap(const Trajectory& reference, const Trajectory& estimate) {
  if (reference.empty() || estimate.empty()) return std::nullopt;
  const double distance = -overlap(reference, estimate);
  if (!(distance > 0.0)) return std::nullopt;
  const bool has_indices = has_frame_indices(estimate) && !has_frame_indices(reference);
  return InputFinding{
      has_indices ? Fault::frame_indices : Fault::no_overlap,
      fmt::format("the estimate's stamps ({:.3f} to {:.3f} s{}) and the reference's ({:.3f} to "
                  "{:.3f} s) have no common time",
                  estimate.front().stamp,
                  estimate.back().stamp,
                  has_indices ? ", whole numbers as of frames" : "",
                  reference.front().stamp,
                  reference.back().stamp),
      has_indices ? "write the estimate's stamps in seconds"
                  : "give files of the same recording, or the offset of their clocks (--offset)",
      1.0,
      distance};
}

std::optional<InputFinding> check_missing(const Trajectory& reference, const Trajectory& estimate) {
  constexpr double kLeastShare = 0.25, kLeastGap = 2.0, kOfInterval = 10.0;
  if (reference.size() < kFewestCommonPoses || estimate.size() < kFewestCommonPoses) {
    return std::nullopt;
  }
  const double least = std::max(kLeastGap, kOfInterval * usual_interval(estimate));
  double all = 0.0, missing = 0.0;  // [m]
  double longest = 0.0, longest_begin = 0.0;
  std::size_t next = 0;
  for (std::size_t i = 1; i < reference.size(); ++i) {
    const auto& [stamp, pose] = reference[i];
    const double step = (pose.translation - reference[i - 1].world_from_body.translation).norm();
    all += step;
    while (next < estimate.size() && estimate[next].stamp < stamp) ++next;
    const double begin = next == 0 ? reference.front().stamp : estimate[next - 1].stamp;
    const double end = next == estimate.size() ? reference.back().stamp : estimate[next].stamp;
    if (end - begin < least) continue;
    missing += step;
    if (end - begin <= longest) continue;
    longest = end - begin;
    longest_begin = begin;
  }
  const double share = all > 0.0 ? missing / all : 0.0;
  if (share < kLeastShare) return std::nullopt;
  return InputFinding{
      Fault::missing_poses,
      fmt::format("the estimate has no poses for {:.0f} % of the reference's path; the longest "
                  "gap has {:.1f} s and begins at {:.3f}",
                  100.0 * share,
                  longest,
                  longest_begin),
      "errors hold for the covered part only: state the coverage, or run the system again",
      1.0,
      share};
}

}  // namespace loopbench::metrics
