#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/core/se3.hpp"
#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/offset_search.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kManyIntervals = 600;  // correlations are known to 0.04
constexpr std::size_t kFewIntervals = 60;    // for many offsets: correlations to 0.13
constexpr double kSameCorrelation = 0.85;    // of offsets and rates that nothing else supports
constexpr double kNear = 10.0;               // [s]; larger offsets fit by chance more often

/// Pearson's correlation; 0 for a constant.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto centred = [](const std::vector<double>& values) {
    const Eigen::Map<const Eigen::VectorXd> all(values.data(), std::ssize(values));
    return Eigen::VectorXd(all.array() - all.mean());
  };
  const Eigen::VectorXd x = centred(a), y = centred(b);
  const double norm = x.norm() * y.norm();
  return norm > 0.0 ? x.dot(y) / norm : 0.0;
}

struct SpeedScore {
  double angle = 0.0, distance = 0.0;
  bool is_known = false;  ///< at least a fifth of the intervals are common

  /// One of the speeds is enough: a vehicle at constant speed, a drifting scale.
  double best() const {
    constexpr double kPenalty = 0.15;  // a single speed fits by chance more often
    if (!is_known) return -1.0;
    return std::max({0.5 * (angle + distance), angle - kPenalty, distance - kPenalty});
  }

  /// The correlation that best() evaluates.
  double correlation() const {
    const double mean = 0.5 * (angle + distance);
    return std::max(0.0, best() > mean ? std::max(angle, distance) : mean);
  }
};

/// Linear and angular speeds of both over intervals of the estimate that do not overlap, at most
/// `most` and evenly chosen, of at least `shortest` [s]. Its stamps are read as begin + factor *
/// (stamp - first).
class SpeedMatch {
 public:
  SpeedMatch(const Trajectory& reference,
             const Trajectory& estimate,
             std::size_t most,
             double shortest,
             double begin,
             double factor = 1.0)
      : reference_(reference), gap_(std::max(shortest, longest_gap(reference))) {
    const std::size_t step = std::max<std::size_t>(1, estimate.size() / most);
    const auto time = [&](double stamp) {
      return begin + factor * (stamp - estimate.front().stamp);
    };
    for (std::size_t i = 0, j = 0; i < estimate.size(); i = std::max(j, i + step)) {
      j = first_from(estimate, estimate[i].stamp + shortest / factor);
      if (j == estimate.size()) break;
      const double from = time(estimate[i].stamp), to = time(estimate[j].stamp);
      if (to - from > kUsualGaps * shortest) continue;
      intervals_.push_back({from, to, estimate[i].world_from_body, estimate[j].world_from_body});
    }
  }

  auto size() const { return static_cast<double>(intervals_.size()); }

  /// O(intervals log n).
  SpeedScore score(double offset) const {
    std::vector<double> angles[2], distances[2];
    const auto add = [&](int of, const Pose& from, const Pose& to, double seconds) {
      const double angle = has_rotation(from) ? angle_between(from.rotation, to.rotation) : 0.0;
      angles[of].push_back(angle / seconds);
      distances[of].push_back((to.translation - from.translation).norm() / seconds);
    };
    for (const auto& [begin, end, from, to] : intervals_) {
      const auto reference_from = pose_near(reference_, begin + offset, gap_);
      if (!reference_from) continue;
      const auto reference_to = pose_near(reference_, end + offset, gap_);
      if (!reference_to) continue;
      add(0, *reference_from, *reference_to, end - begin);
      add(1, from, to, end - begin);
    }
    if (angles[0].size() < std::max(kFewestCommonPoses / 2, intervals_.size() / 5)) return {};
    return {correlation(angles[0], angles[1]), correlation(distances[0], distances[1]), true};
  }

  double at(double offset) const { return score(offset).best(); }

 private:
  struct Interval {
    double begin, end;  // [s]
    Pose from, to;
  };
  const Trajectory& reference_;
  double gap_;
  std::vector<Interval> intervals_;
};

struct BestOffset {
  double offset = 0.0;
  double score = -1.0;
};

/// Periodic speeds fit equally well at several offsets; of these, the one near zero is likely.
BestOffset search_offsets(const SpeedMatch& match, double low, double high, double step) {
  constexpr double kLikely = 1.0,
                   kPart = 0.1;  // [s]; of what the speeds do not explain
  const auto steps = static_cast<int>(std::floor((high - low) / step + 1e-6));
  BestOffset best;
  for (int i = 0; i <= steps; ++i) {
    const double offset = low + i * step, score = match.at(offset);
    const double less = std::abs(offset) > kLikely ? kPart * (1.03 - score) : 0.0;
    if (score - less > best.score) best = {offset, score - less};
  }
  return best;
}

/// Shortest interval over which speeds exceed noise [s].
double least_interval(const Trajectory& reference, const Trajectory& estimate) {
  constexpr double kShortest = 0.1;
  return std::max({kShortest, usual_interval(reference), 0.99 * usual_interval(estimate)});
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
                                               const Trajectory& estimate) {
  constexpr double kWindow = 1.0, kOfDuration = 1.0 / 30.0, kShortest = 0.2;  // [s]
  constexpr double kMostPoints = 4000.0, kUneven = 0.987;  // steps that are no multiples of rates
  constexpr double kAsLikely = 3.0;                        // logarithm of odds of 20 to 1
  if (std::min(reference.size(), estimate.size()) < kFewestCommonPoses) return std::nullopt;
  const auto [shorter, longer] = std::minmax({duration(reference), duration(estimate)});
  const double usual = 2.0 * std::max(usual_interval(reference), usual_interval(estimate));
  const double window = std::max({std::clamp(kOfDuration * shorter, kShortest, kWindow), usual});
  const double step =
      std::max(kUneven * window / static_cast<double>(kWindowSteps), longer / kMostPoints);
  const OffsetSearch search(speed_grid(reference, step, longest_gap(reference)),
                            speed_grid(estimate, step, longest_gap(estimate)));
  const std::vector<OffsetFit> found = search.best();
  if (found.empty()) return std::nullopt;
  const OffsetFit& best = found.front();
  const OffsetFit as_read = search.at(0.0);
  const double second = found.size() > 1 ? found[1].likelihood : 0.0;
  const auto score = [](const OffsetFit& fit) { return SpeedScore{fit.angle, fit.distance, true}; };
  TimeOffset out{.offset = best.offset,
                 .deviation = best.deviation,
                 .agreement = std::max(0.0, score(best).best()),
                 .correlation = score(best).correlation(),
                 .before = score(as_read).correlation(),
                 .has_common_time = as_read.points >= 0.2 * search.size(),
                 .odds = best.likelihood - std::max(0.0, second)};
  if (out.agreement < kLeastCorrelation || !(out.odds >= kAsLikely)) return std::nullopt;
  return out;
}

namespace {

/// ": the difference of GPS time and UTC", if it is one.
std::string leap_of(double size) {
  constexpr double kSame = 0.25;  // [s]
  constexpr std::pair<double, const char*> kLeaps[] = {
      {18.0, "GPS time and UTC"}, {37.0, "TAI and UTC"}, {19.0, "TAI and GPS time"}};
  for (const auto& [seconds, clocks] : kLeaps) {
    if (std::abs(size - seconds) < kSame)
      return fmt::format(" ({:g} s is the difference of {})", seconds, clocks);
  }
  return "";
}

std::string offset_text(const TimeOffset& found, double offset, double rows, bool has_stamps) {
  if (!has_stamps) {
    return fmt::format("row i of the estimate belongs to row i {} {:.0f} of the reference",
                       rows > 0.0 ? "+" : "-",
                       std::abs(rows));
  }
  return fmt::format("the estimate's stamps are {:.3f} +- {:.3f} s (95 %) {} the reference's{}",
                     std::abs(offset),
                     found.half_interval(),
                     offset > 0.0 ? "behind" : "ahead of",
                     leap_of(std::abs(offset)));
}

}  // namespace

std::optional<InputFinding> offset_finding(const TimeOffset& found,
                                           const Trajectory& reference,
                                           const Trajectory& estimate,
                                           bool has_stamps) {
  constexpr double kOfInterval = 0.35, kDeviations = 5.0;  // [s]; significant
  constexpr double kSure = 10.0;                           // of odds of far offsets
  const double size = std::abs(found.offset), period = usual_interval(estimate);
  const double significant = kOfInterval * std::min(0.2, period);
  if (size < std::max({kLeastOffset, significant, kDeviations * found.deviation}))
    return std::nullopt;
  const double rows = std::round(found.offset / period);
  const bool is_whole = std::abs(found.offset - rows * period) < kOfInterval * period;
  const auto most_rows = static_cast<double>(std::max(reference.size(), estimate.size()));
  const bool is_row = is_whole && rows != 0.0 && std::abs(rows) < most_rows;
  if (!has_stamps && !is_row) return std::nullopt;
  const double offset = has_stamps ? found.offset : rows * period;
  const bool is_far = !found.has_common_time || size > kNear;
  if (is_far && (found.odds < kSure ||
                 (!found.has_common_time && found.agreement < kSameCorrelation - 0.15))) {
    return std::nullopt;
  }
  double confidence = 0.5;
  std::string change =
      fmt::format("correlation of speeds {:.3f} -> {:.3f}", found.before, found.correlation);
  if (found.has_common_time) {
    const Agreement before = agreement(common_poses(reference, estimate));
    const Agreement after = agreement(common_poses(reference, estimate, offset));
    const Improvement gained = improvement(before, after);
    if (gained.ratio > kMostRatio || after.cost() > before.cost()) return std::nullopt;
    change += ", " + gained.text;
    confidence = std::max(kLeastConfidence, 1.0 - gained.ratio);
  }
  return InputFinding{Fault::time_offset,
                      offset_text(found, offset, rows, has_stamps) + ": " + change,
                      fmt::format("--offset {:.4f}", offset),
                      confidence,
                      offset};
}

std::optional<InputFinding> check_rate(const Trajectory& reference, const Trajectory& estimate) {
  constexpr double kCells = 120.0;  // of the reference, whose speeds are compared
  constexpr int kSearched = 6;      // per cent of the rate, and cells
  const double cell = duration(reference) / kCells;
  double factor = 1.0;
  BestOffset best;
  const auto search = [&](double begin, double each) {
    const SpeedMatch match(reference, estimate, kFewIntervals, cell, begin, each);
    const BestOffset found = search_offsets(match, -kSearched * cell, kSearched * cell, cell);
    if (found.score < best.score) return;
    best = found;
    factor = each;
  };
  for (int percent = -kSearched; percent <= kSearched; ++percent) {
    search(reference.front().stamp,
           duration(reference) / duration(estimate) * (1.0 + 0.01 * static_cast<double>(percent)));
  }
  // Half or twice the rate, from the first stamp on: the files can begin and end at other times.
  for (const double each : {0.5, 2.0}) search(estimate.front().stamp, each);
  if (best.score < kSameCorrelation) return std::nullopt;
  const bool has_indices = has_frame_indices(estimate) && !has_frame_indices(reference);
  return InputFinding{
      has_indices ? Fault::no_overlap : Fault::missing_poses,
      fmt::format("the estimate's stamps {}: multiplied by {:.3g}, correlation of "
                  "speeds {:.2f}",
                  has_indices ? "are frame numbers" : "have another rate, or it lacks poses",
                  factor,
                  best.score),
      "write the stamp of each frame in seconds",
      kSameCorrelation,
      factor,
      has_indices};
}

}  // namespace loopbench::metrics
