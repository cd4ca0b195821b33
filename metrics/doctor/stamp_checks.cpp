#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "metrics/doctor/clock.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::metrics {

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

namespace {

constexpr double kMostRate = 0.06;  // of a drifting clock [s/s]

/// Time offsets of consecutive parts of the estimate, of those where one is found.
struct PartOffsets {
  std::vector<double> centres, offsets;  ///< [s]
  double deviation = 0.0;                ///< largest standard deviation of an offset [s]
  Trajectory shifted;                    ///< each part with its own offset

  double change() const { return offsets.back() - offsets.front(); }
  double rate() const { return change() / (centres.back() - centres.front()); }
  double range() const { return std::ranges::max(offsets) - std::ranges::min(offsets); }
  double drifted(double stamp) const { return offsets[0] + rate() * (stamp - centres[0]); }

  /// Largest difference from a constant drift [s].
  double residual() const {
    double out = 0.0;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      out = std::max(out, std::abs(offsets[i] - drifted(centres[i])));
    }
    return out;
  }
};

PartOffsets part_offsets(std::size_t count,
                         const Trajectory& reference,
                         const Trajectory& estimate,
                         double searched) {
  constexpr double kUsual = 3.0, kAgrees = 0.9;  // [s]; correlation
  PartOffsets out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](std::size_t part) {
      return estimate.begin() + static_cast<std::ptrdiff_t>(part * estimate.size() / count);
    };
    const Trajectory part(at(i), at(i + 1));
    auto found = estimate_time_offset(reference, part, kUsual);
    if (!found || found->correlation < kAgrees) {
      found = estimate_time_offset(reference, part, searched);
    }
    if (!found || !found->has_common_time) continue;
    out.centres.push_back(0.5 * (part.front().stamp + part.back().stamp));
    out.offsets.push_back(found->offset);
    out.deviation = std::max(out.deviation, found->deviation);
    for (const StampedPose& pose : restamped(part, 1.0, found->offset)) {
      if (out.shifted.empty() || pose.stamp > out.shifted.back().stamp) out.shifted.push_back(pose);
    }
  }
  return out;
}

/// Whether a change of the offsets is as small as their uncertainty, or as usual clocks have it.
bool is_negligible(const PartOffsets& parts, bool is_drift, double interval) {
  constexpr double kLeast = 0.015, kOfInterval = 0.1, kDeviations = 3.0;  // of the change [s]
  constexpr double kLeastJump = 0.2;                                      // [s]
  constexpr double kLeastRate = 5e-4;  // clocks of computers differ by 1e-4 at most
  if (!is_drift) return parts.range() < kLeastJump;
  const double least = std::max({kLeast, kOfInterval * interval, kDeviations * parts.deviation});
  return std::abs(parts.change()) < least || std::abs(parts.rate()) < kLeastRate;
}

/// A drift that three parts of the estimate show, or jumps between five.
std::optional<InputFinding> repair_clock_of_parts(std::size_t count,
                                                  const Trajectory& reference,
                                                  Trajectory& estimate,
                                                  bool has_stamps) {
  constexpr double kSearched = 12.0, kOfChange = 0.3, kSmallRate = 0.01;  // [s]; [-]; [s/s]
  constexpr double kMostOfRotation = 0.98, kMostOfPosition = 0.5;         // of the error before
  constexpr double kMostOfLargeChange = 0.8;
  constexpr double kFits = 0.4;  // of the reference's spread
  constexpr std::size_t kPartsOfDrift = 3;
  if (estimate.size() < count * kFewestCommonPoses || reference.empty() ||
      overlap(reference, estimate) <= 0.0) {
    return std::nullopt;
  }
  const double missing = has_stamps ? 0.0 : duration(reference) - duration(estimate);
  const double searched = std::max({kSearched, kMostRate * duration(estimate), missing});
  const PartOffsets parts = part_offsets(count, reference, estimate, searched);
  const std::vector<double>& offsets = parts.offsets;
  if (offsets.size() < kPartsOfDrift) return std::nullopt;
  const double change = std::abs(parts.change()), rate = parts.rate(), error = parts.residual();
  const bool is_drift = error <= kOfChange * change && std::abs(rate) <= kMostRate;
  if (is_negligible(parts, is_drift, median_interval(estimate))) return std::nullopt;

  Trajectory corrected =
      is_drift ? restamped(estimate, 1.0 + rate, parts.drifted(0.0)) : parts.shifted;
  const Agreement before = agreement(common_poses(reference, estimate, median_value(offsets)));
  const Agreement after = agreement(common_poses(reference, corrected));
  const bool by_rotation = before.has_rotations;
  const double was = by_rotation ? 100.0 * before.turning : before.similarity;
  const double is = by_rotation ? 100.0 * after.turning : after.similarity;
  const bool is_small = is_drift && std::abs(rate) < kSmallRate;
  const double most = !by_rotation ? kMostOfPosition
                      : is_small   ? kMostOfRotation
                                   : kMostOfLargeChange;
  const bool is_other_count = count == kPartsOfDrift ? !is_drift : is_small;
  if (!(is < most * was) || is_other_count) return std::nullopt;
  if (!is_drift && after.similarity > kFits * after.spread) return std::nullopt;
  estimate = std::move(corrected);
  const std::string change_of_error =
      fmt::format("{} {:.3g} -> {:.3g} {}",
                  by_rotation ? "error of relative rotations" : "position error",
                  was,
                  is,
                  by_rotation ? "%" : "m");
  if (!is_drift) {
    return InputFinding{Fault::clock_drift,
                        fmt::format("the estimate's clock jumps, or poses are missing: the offsets "
                                    "of its parts are {:.3f} s; {}",
                                    fmt::join(offsets, ", "),
                                    change_of_error),
                        "add its offset to the stamps of each part, or write all poses",
                        1.0 - is / was,
                        parts.range()};
  }
  return InputFinding{
      Fault::clock_drift,
      fmt::format("the estimate's clock drifts by {:.3f} %: its offset grows from {:.3f} to "
                  "{:.3f} s; {}",
                  100.0 * rate,
                  offsets.front(),
                  offsets.back(),
                  change_of_error),
      stamps_command(1.0 + rate, parts.drifted(0.0)),
      1.0 - error / change,
      rate};
}

}  // namespace

std::optional<InputFinding> repair_clock(const Trajectory& reference,
                                         Trajectory& estimate,
                                         bool has_stamps) {
  auto found = repair_clock_of_parts(3, reference, estimate, has_stamps);
  return found ? found : repair_clock_of_parts(5, reference, estimate, has_stamps);
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
  constexpr double kLeastShare = 0.25, kLeastLost = 0.12, kLeastGap = 2.0;  // [-], [s]
  if (std::min(reference.size(), estimate.size()) < kFewestCommonPoses) return std::nullopt;
  std::vector<double> covered = stamps(estimate);
  covered.insert(covered.end(), {reference.front().stamp, reference.back().stamp});
  std::ranges::sort(covered);
  TrackingGap longest;
  double missing = 0.0, lost = 0.0;  // [m]; lost: between poses
  for (const TrackingGap& gap : tracking_gaps(reference, covered, 0.0, kLeastGap)) {
    Trajectory inside;
    std::ranges::copy_if(reference, std::back_inserter(inside), [&](const StampedPose& pose) {
      return pose.stamp >= gap.begin && pose.stamp <= gap.end;
    });
    const double length = path_length(inside);
    missing += length;
    if (gap.begin > reference.front().stamp && gap.end < reference.back().stamp) lost += length;
    if (gap.end - gap.begin > longest.end - longest.begin) longest = gap;
  }
  const double all = path_length(reference);
  const double share = all > 0.0 ? missing / all : 0.0;
  if (share < kLeastShare && lost <= kLeastLost * all) return std::nullopt;
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
