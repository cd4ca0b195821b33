#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/speed_match.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

/// The vertex of the parabola through three scores, and its standard deviation in least squares of
/// the angles and of the distances: from the part of both that is not explained, and the curvature
/// of their correlations.
void refine(const SpeedMatch& match, double step, TimeOffset& out) {
  const SpeedScore left = match.score(out.offset - step), middle = match.score(out.offset),
                   right = match.score(out.offset + step);
  double information = 0.0;
  for (double SpeedScore::*part : {&SpeedScore::angle, &SpeedScore::distance}) {
    const double curvature = (2.0 * middle.*part - left.*part - right.*part) / (step * step);
    const double residual = 1.0 - middle.*part * middle.*part;
    if (residual > 0.0 && curvature > 0.0) information += curvature / residual;
  }
  out.deviation = information > 0.0 ? 1.0 / std::sqrt(information * match.size()) : INFINITY;
  const double curvature = left.best() - 2.0 * middle.best() + right.best();
  if (!(curvature < 0.0)) return;
  out.offset += std::clamp(0.5 * step * (left.best() - right.best()) / curvature, -step, step);
}

}  // namespace

double speed_correlation(const Trajectory& reference, const Trajectory& estimate, double offset) {
  if (reference.empty() || estimate.empty()) return 0.0;
  const double interval = least_interval(reference, estimate);
  const SpeedMatch match(
      reference, estimate, kManyIntervals, interval, estimate.front().stamp + offset);
  return std::max(0.0, match.at(0.0));
}

std::optional<TimeOffset> estimate_time_offset(const Trajectory& reference,
                                               const Trajectory& estimate,
                                               double searched,
                                               bool is_limited) {
  constexpr double kSteps = 200.0;  // of the search of all overlaps
  if (std::min(reference.size(), estimate.size()) < kFewestCommonPoses) return std::nullopt;
  const double first = estimate.front().stamp, interval = least_interval(reference, estimate);
  const SpeedMatch match(reference, estimate, kManyIntervals, interval, first);
  const SpeedMatch few(reference, estimate, kFewIntervals, interval, first);
  TimeOffset out;
  const SpeedScore before = match.score(0.0);
  out.before = std::max(0.0, before.best());
  out.has_common_time = before.is_known;
  const double coarse = std::clamp(interval, 0.2, 0.5), fine = 0.2 * coarse;
  const bool agrees =
      before.best() > std::max({kSameCorrelation, match.at(-coarse), match.at(coarse)});
  BestOffset best{0.0, before.best()};
  if (!agrees) best = search_offsets(few, -searched, searched, coarse);
  if (best.score < kLeastCorrelation && !is_limited) {
    // At least half of the shorter one must be common: a short overlap can fit by chance.
    const double shorter = std::min(duration(reference), duration(estimate));
    const double low = reference.front().stamp - estimate.back().stamp + 0.5 * shorter;
    const double high = reference.back().stamp - estimate.front().stamp - 0.5 * shorter;
    const double step = std::max(coarse, (high - low) / kSteps);
    const SpeedMatch wide(reference, estimate, kFewIntervals, std::max(interval, step), first);
    const double rough = search_offsets(wide, low, high, step).offset;
    best = search_offsets(few, rough - step, rough + step, std::max(coarse, step / kSteps));
  }
  if (before.best() > best.score) best = {0.0, before.best()};
  best = search_offsets(match, best.offset - coarse, best.offset + coarse, fine);
  if (best.score < kLeastCorrelation - 0.1) return std::nullopt;  // refine() may raise it
  out.offset = best.offset;
  refine(match, fine, out);
  // Where stamps are equal, interpolation smooths neighbouring offsets.
  if (std::isinf(out.deviation)) refine(match, coarse, out);
  out.correlation = match.at(out.offset);
  if (out.correlation < kLeastCorrelation) return std::nullopt;
  return out;
}

std::optional<InputFinding> offset_finding(const TimeOffset& found,
                                           const Trajectory& reference,
                                           const Trajectory& estimate,
                                           bool has_stamps) {
  constexpr double kOfInterval = 0.35, kDeviations = 5.0;  // [s]; significant
  constexpr double kLeastGain = 0.1, kMostRatio = 0.9;     // of the errors after an alignment
  constexpr double kMostUsual = 0.8;                       // of the median error of rotations
  const double size = std::abs(found.offset), period = usual_interval(estimate);
  const double significant = kOfInterval * std::min(0.2, period);
  if (size < std::max({kLeastOffset, significant, kDeviations * found.deviation}))
    return std::nullopt;
  const double rows = std::round(found.offset / period);
  const bool is_whole = std::abs(found.offset - rows * period) < kOfInterval * period;
  if (!has_stamps && (rows == 0.0 || !is_whole)) return std::nullopt;
  const double offset = has_stamps ? found.offset : rows * period;
  double confidence = 0.5;
  std::string change =
      fmt::format("correlation of speeds {:.3f} -> {:.3f}", found.before, found.correlation);
  if (found.has_common_time) {
    const Agreement before = agreement(common_poses(reference, estimate));
    const Agreement after = agreement(common_poses(reference, estimate, offset));
    Improvement gained = improvement(before, after);
    const double usual = after.usual_turning / std::max(kNoNoise, before.usual_turning);
    // Where an estimate is lost, its errors hide a shift of rows, but not in their median.
    const bool is_usual = !has_stamps && usual < kMostUsual;
    if (is_usual && usual < gained.ratio)
      gained = {fmt::format("median error of relative rotations {:.2g} -> {:.2g} deg",
                            kDegrees * before.usual_turning,
                            kDegrees * after.usual_turning),
                usual};
    const double least = is_usual ? 0.0 : kLeastGain;
    if (after.cost() > before.cost() - least || gained.ratio > kMostRatio) return std::nullopt;
    change += ", " + gained.text;
    confidence = std::max(kLeastConfidence, 1.0 - gained.ratio);
  }
  const bool is_near = found.has_common_time && size <= kNear;
  if (!is_near && found.correlation < kSameCorrelation) return std::nullopt;
  const std::string what =
      has_stamps ? fmt::format("the estimate's stamps are {:.3f} +- {:.3f} s {} the reference's",
                               size,
                               found.deviation,
                               offset > 0.0 ? "behind" : "ahead of")
                 : fmt::format("row i of the estimate belongs to row i {} {:.0f} of the reference",
                               rows > 0.0 ? "+" : "-",
                               std::abs(rows));
  return InputFinding{Fault::time_offset,
                      what + ": " + change,
                      fmt::format("--offset {:.4f}", offset),
                      confidence,
                      offset};
}

}  // namespace loopbench::metrics
