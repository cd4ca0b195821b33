#include "metrics/doctor/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/repairs.hpp"
#include "metrics/doctor/speed_match.hpp"
#include "metrics/doctor/time_offset.hpp"

namespace loopbench::metrics {
namespace {

/// Positions without rotations with constant ones.
Trajectory with_rotations(Trajectory poses) {
  if (!lacks_rotations(poses)) return poses;
  for (StampedPose& pose : poses) pose.world_from_body.rotation = Rotation::Identity();
  return poses;
}

/// The pair with the repairs of what was found.
class PairDiagnosis {
 public:
  PairDiagnosis(Trajectory reference, Trajectory estimate)
      : reference_(std::move(reference)), estimate_(std::move(estimate)) {}

  Diagnosis run(const std::string& reference_name,
                const std::string& estimate_name,
                bool has_stamps) {
    add(check_swapped(reference_name, estimate_name));
    if (has_stamps) {
      check_stamps();
    } else {
      out_.unchecked.emplace_back("time offset: a file has no stamps");
    }
    check_poses();
    std::erase_if(out_.findings,
                  [](const InputFinding& f) { return f.confidence < kLeastConfidence; });
    return std::move(out_);
  }

 private:
  void add(std::optional<InputFinding> found) {
    if (found) out_.findings.push_back(std::move(*found));
  }

  void add(std::optional<StampRepair> found) {
    if (!found) return;
    add(std::move(found->finding));
    out_.has_checked = true;
    Trajectory& poses = found->is_of_reference ? reference_ : estimate_;
    poses = restamped(std::move(poses), found->factor, found->offset);
  }

  void check_stamps() {
    add(check_stamp_unit(reference_, estimate_));
    auto clock = check_frame_indices(reference_, estimate_);
    if (!clock) clock = check_clock_drift(reference_, estimate_);
    const bool has_offset = !clock || clock->finding.fault == Fault::frame_indices;
    add(std::move(clock));
    if (has_offset && !estimate_.empty()) check_offset();
  }

  void check_offset() {
    if (std::min(reference_.size(), estimate_.size()) < kFewestCommonPoses) {
      out_.unchecked.emplace_back("time offset: fewer than 20 poses");
    }
    speeds_ = estimate_time_offset(reference_, estimate_);
    auto found = speeds_ ? offset_finding(*speeds_, reference_, estimate_) : std::nullopt;
    out_.has_checked |= speeds_.has_value();
    if (!found) {
      if (auto apart = check_overlap(reference_, estimate_)) {
        add(std::move(apart));
      } else {
        add(check_missing(reference_, estimate_));
      }
      return;
    }
    for (StampedPose& pose : estimate_) pose.stamp += speeds_->offset;
    add(std::move(found));
    out_.offset = speeds_;
    add(check_missing(reference_, estimate_));
  }

  void check_poses() {
    constexpr int kMostRepairs = 3;
    add(check_constant_rotation(reference_, estimate_));
    CommonPoses poses = common_poses(reference_, estimate_, 0.0, kMostCommonPoses);
    if (poses.stamps.size() < kFewestCommonPoses) {
      for (const char* checks : {"units, scale", "quaternion order, inverted poses, axes"}) {
        out_.unchecked.push_back(
            fmt::format("{}: {} poses of the estimate are in the reference's time, expected at "
                        "least {}",
                        checks,
                        poses.stamps.size(),
                        kFewestCommonPoses));
      }
      return;
    }
    for (const bool is_reference : {true, false}) {
      if (!is_at_rest(is_reference ? reference_ : estimate_)) continue;
      out_.unchecked.push_back(
          fmt::format("units, scale, quaternion order, inverted poses, axes, files of the same "
                      "recording: the {} moves by less than {:g} times its noise",
                      is_reference ? "reference" : "estimate",
                      kLeastOfNoise));
      return;
    }
    out_.has_checked = true;
    if (auto found = check_angle_unit(poses)) {
      add(std::move(found));
      for (auto* list : {&poses.reference, &poses.estimate}) {
        for (Pose& pose : *list) pose.rotation = Rotation::Identity();
      }
    } else {
      note_constant_rotations(poses);
    }
    add(remove_jumps(poses));
    for (int i = 0; i < kMostRepairs; ++i) {
      auto proven = best_repair(poses);
      if (!proven) break;
      proven->repair.apply(poses);
      const Repair& repair = proven->repair;
      add(InputFinding{repair.fault,
                       repair.what + ": " + proven->improvement.text,
                       repair.fix,
                       1.0 - proven->improvement.ratio,
                       repair.value});
    }
    check_recording(agreement(poses));
  }

  void note_constant_rotations(const CommonPoses& poses) {
    for (const bool is_reference : {true, false}) {
      if (has_rotations(is_reference ? poses.reference : poses.estimate)) continue;
      out_.unchecked.push_back(
          fmt::format("quaternion order, inverted poses, axes, unit of angles: the {} does not "
                      "rotate by {:g} rad",
                      is_reference ? "reference" : "estimate",
                      kLeastRotation));
      return;
    }
  }

  /// Nothing agrees, whatever is repaired: replaces all other findings.
  void check_recording(const Agreement& left) {
    constexpr double kTurning = 0.7, kPosition = 0.4, kPositionAlone = 0.7, kCorrelation = 0.6;
    const double position = left.similarity / left.spread;
    const bool disagrees = left.has_rotations ? left.turning > kTurning && position > kPosition
                                              : position > kPositionAlone;
    const SpeedMatch match(reference_, estimate_);
    const double correlation = std::max(0.0, match.at(0.0));
    const double confidence = std::min(1.0, position) * (1.0 - correlation);
    if (!disagrees || correlation > kCorrelation || confidence < kLeastConfidence) return;
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

  Trajectory reference_, estimate_;
  std::optional<TimeOffset> speeds_;
  Diagnosis out_;
};

}  // namespace

Diagnosis diagnosis(const Trajectory& reference,
                    const Trajectory& estimate,
                    const std::string& reference_name,
                    const std::string& estimate_name,
                    bool has_stamps) {
  if (!lacks_rotations(reference) && !lacks_rotations(estimate)) {
    return PairDiagnosis(reference, estimate).run(reference_name, estimate_name, has_stamps);
  }
  Diagnosis out = PairDiagnosis(with_rotations(reference), with_rotations(estimate))
                      .run(reference_name, estimate_name, has_stamps);
  std::erase_if(out.findings, [](const InputFinding& finding) {
    return finding.fault == Fault::constant_rotation;
  });
  return out;
}

}  // namespace loopbench::metrics
