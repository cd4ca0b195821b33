#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/time_offset.hpp"

namespace loopbench::metrics {
namespace {

double duration(const Trajectory& poses) { return poses.back().stamp - poses.front().stamp; }

/// Length of the common range [s]; negative: the distance between the ranges.
double overlap(const Trajectory& a, const Trajectory& b) {
  return std::min(a.back().stamp, b.back().stamp) - std::max(a.front().stamp, b.front().stamp);
}

const char* fraction_name(double factor) {
  if (factor == 1e3) return "milliseconds";
  return factor == 1e6 ? "microseconds" : "nanoseconds";
}

/// Share of the estimate's poses in the reference's time [%].
double paired_share(const Trajectory& reference, const Trajectory& estimate) {
  const auto count = common_poses(reference, estimate, 0.0, estimate.size()).stamps.size();
  return 100.0 * static_cast<double>(count) / static_cast<double>(estimate.size());
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
  if (factor == 0.0) poses.clear();
  for (StampedPose& pose : poses) pose.stamp = factor * pose.stamp + offset;
  return poses;
}

std::optional<StampRepair> check_stamp_unit(const Trajectory& reference,
                                            const Trajectory& estimate) {
  constexpr double kHardly = 0.01, kMostly = 0.5, kLeastPart = 0.05;
  if (reference.size() < 2 || estimate.size() < 2) return std::nullopt;
  const double longer = std::max(duration(reference), duration(estimate));
  if (overlap(reference, estimate) > kHardly * longer) return std::nullopt;
  for (const double factor : {1e3, 1e6, 1e9}) {
    for (const bool is_reference : {false, true}) {
      const Trajectory a = restamped(reference, is_reference ? 1.0 / factor : 1.0, 0.0);
      const Trajectory b = restamped(estimate, is_reference ? 1.0 : 1.0 / factor, 0.0);
      const auto [shorter, other] = std::minmax({duration(a), duration(b)});
      if (shorter < kLeastPart * other || overlap(a, b) < kMostly * shorter) continue;
      return StampRepair{
          {Fault::stamp_unit,
           fmt::format("the stamps of the {} are {:g} times too large ({}): paired poses "
                       "{:.0f} -> {:.0f} %",
                       is_reference ? "reference" : "estimate",
                       factor,
                       fraction_name(factor),
                       paired_share(reference, estimate),
                       paired_share(a, b)),
           fmt::format(
               "traj transform {} --stamp-scale {:g}", is_reference ? "REF" : "EST", 1.0 / factor),
           1.0,
           is_reference ? 1.0 / factor : factor},
          1.0 / factor,
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
  std::optional<TimeOffset> as_read;
  if (overlap(reference, estimate) > 0.0) as_read = estimate_time_offset(reference, estimate, 0.0);
  if (as_read && as_read->before > kAgrees) return std::nullopt;
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
  if (factor == 0.0) {
    if (overlap(reference, estimate) > 0.0) return std::nullopt;
    return StampRepair{
        {Fault::frame_indices,
         fmt::format("the estimate's stamps are whole numbers from {:g} to {:g}, as frame indices; "
                     "no usual frame rate fits: paired poses 0 %",
                     estimate.front().stamp,
                     estimate.back().stamp),
         "write the estimate's stamps in seconds",
         0.7},
        0.0};
  }
  return StampRepair{
      {Fault::frame_indices,
       fmt::format("the estimate's stamps are frame indices: with {:.4g} s per frame, paired poses "
                   "{:.0f} -> {:.0f} %, correlation of speeds {:.2f} -> {:.2f}",
                   factor,
                   paired_share(reference, estimate),
                   paired_share(reference, restamped(estimate, factor, offset)),
                   as_read ? as_read->before : 0.0,
                   best),
       fmt::format("traj transform EST --stamp-scale {:.6g}, then --offset {:.4f}", factor, offset),
       best,
       factor},
      factor,
      offset};
}

std::optional<InputFinding> check_overlap(const Trajectory& reference, const Trajectory& estimate) {
  if (reference.empty() || estimate.empty()) return std::nullopt;
  const double distance = -overlap(reference, estimate);
  if (!(distance > 0.0)) return std::nullopt;
  return InputFinding{Fault::no_overlap,
                      fmt::format("the estimate's stamps ({:.3f} to {:.3f} s) and the reference's "
                                  "({:.3f} to {:.3f} s) have no common time",
                                  estimate.front().stamp,
                                  estimate.back().stamp,
                                  reference.front().stamp,
                                  reference.back().stamp),
                      "give files of the same recording, or the offset of their clocks (--offset)",
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
    next = first_from(estimate, stamp, next);
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
