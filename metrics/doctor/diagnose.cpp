#include "metrics/doctor/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "metrics/doctor/pair_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

constexpr const char* kChecksOfPoses =
    "units, scale, quaternion order, inverted poses, axes, files of the same recording";
constexpr double kConstant = 1e-6;     // of rotations [rad]
constexpr double kLeastOfNoise = 3.0;  // standard deviation of positions over their noise

/// Whether noise explains the positions: their standard deviation is at most kLeastOfNoise times
/// the one of white noise that the median distance of a position from the middle of the ones before
/// and after has. Acceleration adds to it. O(n).
bool is_at_rest(const Trajectory& poses) {
  constexpr double kRounding = 1e-9;
  constexpr double kMeanOverMedian = 3.0 / 2.366;  // of chi-squared with 3 degrees of freedom
  const auto n = static_cast<double>(poses.size());
  Vector3 mean = Vector3::Zero();
  for (const StampedPose& pose : poses) mean += pose.world_from_body.translation / n;
  double variance = 0.0;
  std::vector<double> squares;  // of the distances from the middle
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vector3& position = poses[i].world_from_body.translation;
    variance += (position - mean).squaredNorm() / n;
    if (i == 0 || i + 1 == poses.size()) continue;
    const Vector3 middle =
        0.5 * (poses[i - 1].world_from_body.translation + poses[i + 1].world_from_body.translation);
    squares.push_back((position - middle).squaredNorm() / 1.5);
  }
  const double noise = std::sqrt(kMeanOverMedian * median_value(std::move(squares)));
  return std::sqrt(variance) <= kLeastOfNoise * noise + kRounding * mean.norm();
}

/// Positions without rotations with constant ones.
Trajectory with_rotations(Trajectory poses) {
  if (!lacks_rotations(poses)) return poses;
  for (StampedPose& pose : poses) pose.world_from_body.rotation = Rotation::Identity();
  return poses;
}

/// The pair with the repairs of what was found.
class PairDiagnosis {
 public:
  PairDiagnosis(const Trajectory& reference, const Trajectory& estimate)
      : has_rotations_(!lacks_rotations(reference) && !lacks_rotations(estimate)),
        reference_(with_rotations(reference)),
        estimate_(with_rotations(estimate)) {}

  Diagnosis run(const std::string& reference_name,
                const std::string& estimate_name,
                bool has_stamps) {
    constexpr double kAgrees = 0.8;  // correlation of speeds
    add(check_swapped(reference_name, estimate_name));
    const PairDiagnosis as_read = *this;
    const bool has_jumps = repair_rows();
    // They hide clocks, but only if all else fits: clocks also look like jumps.
    const bool are_clocks = has_jumps && speed_correlation(reference_, estimate_) <= kAgrees;
    if (are_clocks) *this = as_read;
    const std::size_t count = out_.findings.size();
    if (!has_stamps)
      out_.unchecked.emplace_back("stamps: a file has none, its rows count as equally spaced");
    if (has_stamps || reference_.size() != estimate_.size()) check_stamps(has_stamps);
    if (are_clocks || (!has_jumps && out_.findings.size() > count)) repair_rows();
    check_poses();
    std::erase_if(out_.findings,
                  [](const InputFinding& f) { return f.confidence < kLeastConfidence; });
    return std::move(out_);
  }

 private:
  bool add(std::optional<InputFinding> found) {
    if (found) out_.findings.push_back(std::move(*found));
    return found.has_value();
  }

  /// Rows that repeat the one before, and jumps, of the estimate or else of the reference.
  bool repair_rows() {
    for (const bool is_reference : {false, true}) {
      Trajectory& file = is_reference ? reference_ : estimate_;
      const Trajectory& other = is_reference ? estimate_ : reference_;
      const std::string name = is_reference ? "reference" : "estimate";
      const bool stands_still = add(remove_standstill(file, other, name));
      if (add(remove_jumps(file, other, name)) || stands_still) return true;
    }
    return false;
  }

  void check_stamps(bool has_stamps) {
    out_.has_checked = add(repair_stamp_unit(reference_, estimate_));
    const bool has_rate = add(repair_rate(reference_, estimate_, has_stamps));
    if (!has_rate && add(repair_clock(reference_, estimate_, has_stamps))) return;
    if (std::min(reference_.size(), estimate_.size()) < kFewestCommonPoses) {
      out_.unchecked.emplace_back("time offset: fewer than 20 poses");
    }
    if (const auto found = estimate_time_offset(reference_, estimate_)) {
      out_.has_checked = true;
      if (add(offset_finding(*found, reference_, estimate_))) {
        for (StampedPose& pose : estimate_) pose.stamp += found->offset;
      }
    }
    const bool has_missing = std::ranges::any_of(
        out_.findings, [](const InputFinding& f) { return f.fault == Fault::missing_poses; });
    if (!add(check_overlap(reference_, estimate_)) && !has_missing) {
      add(check_missing(reference_, estimate_));
    }
  }

  void check_poses() {
    constexpr int kMostRepairs = 3;
    Paired poses = common_poses(reference_, estimate_);
    if (poses.estimate.size() < kFewestCommonPoses) {
      out_.unchecked.push_back(
          fmt::format("{}: poses of the estimate in the reference's time: {}, expected at least {}",
                      kChecksOfPoses,
                      poses.estimate.size(),
                      kFewestCommonPoses));
      return;
    }
    const bool is_reference = is_at_rest(reference_);
    if (is_reference || is_at_rest(estimate_)) {
      out_.unchecked.push_back(fmt::format("{}: the {} moves by less than {:g} times its noise",
                                           kChecksOfPoses,
                                           is_reference ? "reference" : "estimate",
                                           kLeastOfNoise));
      return;
    }
    out_.has_checked = true;
    if (add(check_angle_unit(poses))) {
      for (auto* list : {&poses.reference, &poses.estimate}) {
        for (StampedPose& pose : *list) pose.world_from_body.rotation = Rotation::Identity();
      }
    } else if (!has_rotations(poses)) {
      note_constant_rotation(largest_rotation_angle(poses.reference),
                             largest_rotation_angle(poses.estimate));
    }
    for (int i = 0; i < kMostRepairs && add(apply_best_repair(poses, out_.findings)); ++i) {
    }
    check_recording(agreement(poses));
  }

  /// A finding only if the other file rotates. Files of positions are meant to have no rotations.
  void note_constant_rotation(double of_reference, double of_estimate) {
    constexpr double kOtherRotates = 0.1;  // [rad]
    const auto [smaller, larger] = std::minmax(of_reference, of_estimate);
    const char* const name = of_reference <= kLeastRotation ? "reference" : "estimate";
    out_.unchecked.push_back(
        fmt::format("quaternion order, inverted poses, axes, unit of angles: the {} does not "
                    "rotate by {:g} rad",
                    name,
                    kLeastRotation));
    if (!has_rotations_ || smaller > kConstant || larger < kOtherRotates) return;
    out_.findings.push_back(
        {Fault::constant_rotation,
         fmt::format("the {}'s rotation is constant while the other file rotates by {:.0f} deg",
                     name,
                     kDegrees * larger),
         "write the file with rotations, or use position errors only (eval -r trans_part)",
         1.0,
         larger});
  }

  /// Nothing agrees, whatever is repaired: replaces all other findings.
  void check_recording(const Agreement& left) {
    constexpr double kTurning = 0.7, kPosition = 0.4, kPositionAlone = 0.7, kCorrelation = 0.6;
    const double position = left.similarity / left.spread;
    const bool disagrees = left.has_rotations ? left.turning > kTurning && position > kPosition
                                              : position > kPositionAlone;
    if (!disagrees) return;
    const double correlation = speed_correlation(reference_, estimate_);
    const double confidence = std::min(1.0, position) * (1.0 - correlation);
    if (correlation > kCorrelation || confidence < kLeastConfidence) return;
    if (auto order = repair_order(estimate_, reference_, "estimate")) {
      out_.findings = {*order};
      return;
    }
    if (auto order = repair_order(reference_, estimate_, "reference")) {
      out_.findings = {*order};
      return;
    }
    out_.findings = {
        {Fault::wrong_recording,
         fmt::format("no repair makes the files agree: after alignment with scale, the position "
                     "error is {:.3g} m, {:.0f} % of the reference's spread; correlation of speeds "
                     "{:.2f}",
                     left.similarity,
                     100.0 * position,
                     correlation),
         "give files of the same recording",
         confidence,
         position}};
  }

  bool has_rotations_;  ///< false: a file has positions only
  Trajectory reference_, estimate_;
  Diagnosis out_;
};

}  // namespace

Diagnosis diagnosis(const Trajectory& reference,
                    const Trajectory& estimate,
                    const std::string& reference_name,
                    const std::string& estimate_name,
                    bool has_stamps) {
  return PairDiagnosis(reference, estimate).run(reference_name, estimate_name, has_stamps);
}

}  // namespace loopbench::metrics
