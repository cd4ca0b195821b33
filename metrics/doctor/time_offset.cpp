#include "metrics/doctor/time_offset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/speed_match.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

struct Best {
  double offset = 0.0;
  double score = -1.0;
};

/// Steps are longer if the range is: files may cover any time, and a stray stamp covers decades.
Best search(const SpeedMatch& match, double low, double high, double step) {
  constexpr double kMostSteps = 20'000.0;
  step = std::max(step, (high - low) / kMostSteps);
  const auto steps = static_cast<int>(std::floor((high - low) / step + 1e-6));
  Best best;
  for (int i = 0; i <= steps; ++i) {
    const double offset = low + i * step;
    const double score = match.at(offset);
    if (score > best.score) best = {offset, score};
  }
  return best;
}

/// Periodic speeds fit equally well at several offsets; of these, the one near zero is the likely
/// one.
Best nearest_of_equal(const SpeedMatch& match, const Best& best, double step) {
  constexpr double kNear = 1.0;  // [s]
  if (std::abs(best.offset) <= kNear) return best;
  const Best refined = search(match, best.offset - 5.0 * step, best.offset + 5.0 * step, step);
  const Best near = search(match, -kNear, kNear, step);
  const double least_gain = std::max(0.003, 0.1 * (1.0 - refined.score));
  return near.score > refined.score - least_gain ? near : refined;
}

/// Vertex of the parabola through three scores.
double vertex(const SpeedMatch& match, double offset, double step) {
  const double left = match.at(offset - step);
  const double middle = match.at(offset);
  const double right = match.at(offset + step);
  const double curvature = left - 2.0 * middle + right;
  if (!(curvature < 0.0)) return offset;
  return offset + std::clamp(0.5 * step * (left - right) / curvature, -step, step);
}

/// Standard deviation of the offset in least squares of the angles and of the distances: from the
/// part of both that is not explained, and the curvature of their correlations.
double deviation_of(const SpeedMatch& match, double offset, double step) {
  const SpeedMatch::Score left = match.score(offset - step), middle = match.score(offset),
                          right = match.score(offset + step);
  double information = 0.0;
  for (double SpeedMatch::Score::*part :
       {&SpeedMatch::Score::angle, &SpeedMatch::Score::distance}) {
    const double curvature = (2.0 * middle.*part - left.*part - right.*part) / (step * step);
    const double residual = 1.0 - middle.*part * middle.*part;
    if (residual > 0.0 && curvature > 0.0) information += curvature / residual;
  }
  return information > 0.0 ? 1.0 / std::sqrt(information * static_cast<double>(match.intervals()))
                           : INFINITY;
}

/// Whether the correlation of the speeds is clearly higher with the offset. At constant speed, it
/// is the same at all offsets but for rounding errors, which can be explained completely.
bool raises_correlation(const TimeOffset& found) {
  constexpr double kGain = 0.005;
  constexpr double kSmallGain = 0.0005, kShare = 0.5;  // of what is unexplained without the offset
  const double gain = found.correlation - found.before;
  return gain >= kGain || (gain >= kSmallGain && gain >= kShare * (1.0 - found.before));
}

/// 1 - correlation after over before, of the speed for which this is smaller.
double unexplained(const SpeedMatch::Score& before, const SpeedMatch::Score& after) {
  const auto ratio = [](double now, double then) {
    constexpr double kUseful = 0.7;
    constexpr double kRounding = 1e-6;  // at a constant speed all offsets fit equally well
    if (1.0 - then < kRounding) return 1.0;
    return now < kUseful ? 1.0 : (1.0 - now) / std::max(1e-9, 1.0 - std::max(0.0, then));
  };
  return std::min(ratio(after.angle, before.angle), ratio(after.distance, before.distance));
}

}  // namespace

std::optional<TimeOffset> estimate_time_offset(const Trajectory& reference,
                                               const Trajectory& estimate,
                                               double searched) {
  constexpr std::size_t kFewestPoses = 20;
  constexpr double kLeastCorrelation = 0.6, kLeastOfSpeeds = 0.3;
  if (reference.size() < kFewestPoses || estimate.size() < kFewestPoses) return std::nullopt;
  const SpeedMatch match(reference, estimate);
  TimeOffset out;
  const SpeedMatch::Score before = match.score(0.0);
  const double at_zero = before.best();
  out.before = std::max(0.0, at_zero);
  out.has_common_time = before.is_known;
  const double coarse = std::clamp(match.interval(), 0.1, 0.5);
  Best best = search(match, -searched, searched, coarse);
  if (best.score < 0.0) {
    constexpr double kMostSteps = 2000.0;
    // At least half of the shorter one must be common: a short overlap can fit by chance.
    const double duration = std::min(reference.back().stamp - reference.front().stamp,
                                     estimate.back().stamp - estimate.front().stamp);
    const double low = reference.front().stamp - estimate.back().stamp + 0.5 * duration;
    const double high = reference.back().stamp - estimate.front().stamp - 0.5 * duration;
    best = search(match, low, high, std::max(coarse, (high - low) / kMostSteps));
    const double step = std::max(coarse, (high - low) / kMostSteps);
    best = search(match, best.offset - step, best.offset + step, 0.2 * coarse);
  }
  if (at_zero > best.score) best = {0.0, at_zero};
  const double fine = 0.2 * coarse;
  if (before.is_known) best = nearest_of_equal(match, best, fine);
  best = search(match, best.offset - coarse, best.offset + coarse, fine);
  out.offset = vertex(match, best.offset, fine);
  const SpeedMatch::Score after = match.score(out.offset);
  out.correlation = after.best();
  if (out.correlation < kLeastCorrelation ||
      match.score_of_speeds(out.offset).best() < kLeastOfSpeeds) {
    return std::nullopt;
  }
  out.unexplained = unexplained(before, after);
  out.deviation = deviation_of(match, out.offset, 0.5 * fine);
  return out;
}

std::optional<InputFinding> offset_finding(const TimeOffset& found,
                                           const Trajectory& reference,
                                           const Trajectory& estimate) {
  constexpr double kSmallest = 0.02, kOfInterval = 0.35, kDeviations = 5.0;  // [s]
  constexpr double kSmall = 0.1;  // [s]; these need smaller errors
  constexpr double kLeastGain = 0.1, kMostRatio = 0.9, kLeastConfident = 0.3;
  constexpr double kMostUnexplained = 0.7;
  constexpr double kLeastAlone = 0.85;  // correlation of files without common time
  const double size = std::abs(found.offset);
  const double interval = std::min(0.2, usual_interval(estimate));
  if (size < std::max({kSmallest, kOfInterval * interval, kDeviations * found.deviation})) {
    return std::nullopt;
  }
  double confidence = 0.5;
  std::string change =
      fmt::format("correlation of speeds {:.3f} -> {:.3f}", found.before, found.correlation);
  if (!found.has_common_time) {
    if (found.correlation < kLeastAlone) return std::nullopt;
  } else if (size < kSmall) {
    const auto errors = [&](double offset) {
      return agreement(common_poses(reference, estimate, offset, kMostCommonPoses));
    };
    const Agreement before = errors(0.0), after = errors(found.offset);
    const Improvement gained = improvement(before, after);
    if (after.cost() > before.cost() - kLeastGain || gained.ratio > kMostRatio) return std::nullopt;
    change += ", " + gained.text;
    confidence = std::max(kLeastConfident, 1.0 - gained.ratio);
  } else {
    const SpeedMatch match(reference, estimate, Part::tested);
    const double remaining = unexplained(match.score(0.0), match.score(found.offset));
    if (!raises_correlation(found) || std::max(found.unexplained, remaining) > kMostUnexplained) {
      return std::nullopt;
    }
    confidence = 1.0 - remaining;
  }
  return InputFinding{Fault::time_offset,
                      fmt::format("the estimate's stamps are {:.3f} +- {:.3f} s {} the "
                                  "reference's: {}",
                                  size,
                                  found.deviation,
                                  found.offset > 0.0 ? "behind" : "ahead of",
                                  change),
                      fmt::format("--offset {:.4f}", found.offset),
                      confidence,
                      found.offset};
}

}  // namespace loopbench::metrics
