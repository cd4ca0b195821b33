#include "metrics/doctor/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/map_checks.hpp"
#include "metrics/doctor/order_checks.hpp"
#include "metrics/doctor/pair_checks.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {
namespace {

constexpr const char* kChecksOfPoses =
    "units, scale, quaternion order, inverted poses, axes, files of the same "
    "recording";
constexpr double kLeastOfNoise = 3.0;  // standard deviation of positions over their noise

/// Whether noise explains the positions: their standard deviation is at most kLeastOfNoise times
/// their median distance from the middle of the ones before and after, which is 1.1 standard
/// deviations of white noise. Acceleration adds to it. O(1).
bool is_at_rest(const Trajectory& poses) {
  const auto at = [&](std::size_t i) -> const Vector3& {
    return poses[i].world_from_body.translation;
  };
  const std::size_t step = even_step(poses.size(), kMostPoses);
  const double spread = spread_of((poses.size() - 1) / step + 1,
                                  [&](std::size_t k) -> const Vector3& { return at(k * step); });
  std::vector<double> distances;
  for (std::size_t i = 1; i + 1 < poses.size(); i += step)
    distances.push_back((at(i) - 0.5 * (at(i - 1) + at(i + 1))).norm());
  return spread <=
         kLeastOfNoise * median_value(std::move(distances)) + kFileRounding * at(0).norm();
}

/// The pair with the repairs of what was found.
class PairDiagnosis {
 public:
  PairDiagnosis(const Trajectory& reference, const Trajectory& estimate, bool has_stamps)
      : reference_(&reference), estimate_(&estimate), has_stamps_(has_stamps) {}

  Diagnosis run(const std::string& reference_name, const std::string& estimate_name) {
    add(check_swapped(reference_name, estimate_name));
    check_stamps();
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

  void check_stamps() {
    if (!has_stamps_)
      out_.unchecked.emplace_back("stamps: a file has none, its rows count as equally spaced");
    repair_unit_of_stamps();
    if (std::min(reference_->size(), estimate_->size()) < kFewestCommonPoses)
      out_.unchecked.emplace_back("time offset: fewer than 20 poses");
    if (const auto found = estimate_time_offset(*reference_, *estimate_)) {
      out_.has_checked = true;
      if (add(offset_finding(*found, *reference_, *estimate_, has_stamps_)))
        offset_ = out_.findings.back().value;
    }
    const bool are_rows = !has_stamps_ && reference_->size() == estimate_->size();
    if (!add(check_overlap(*reference_, *estimate_, offset_)) && !are_rows)
      add(check_missing(*reference_, *estimate_, offset_));
  }

  void repair_unit_of_stamps() {
    if (!add(check_stamp_unit(*reference_, *estimate_))) return;
    const double divisor = out_.findings.back().value;
    const bool is_estimate = divisor > 1.0;
    out_.has_checked = true;
    changed_ = is_estimate ? *estimate_ : *reference_;
    for (StampedPose& pose : changed_) pose.stamp *= is_estimate ? 1.0 / divisor : divisor;
    (is_estimate ? estimate_ : reference_) = &changed_;
  }

  static constexpr std::size_t kMostRows = 5000;  // a jump between two poses is found at any size

  /// At the rows of the estimate, or else of the reference.
  Paired rows_of(bool reference) const {
    if (!reference) return common_poses(*reference_, *estimate_, offset_, kMostRows);
    Paired out = common_poses(*estimate_, *reference_, -offset_, kMostRows);
    std::swap(out.reference, out.estimate);
    return out;
  }

  /// Jumps, new maps, frozen poses and changes of scale of the estimate, or else jumps and frozen
  /// poses of the reference.
  void repair_parts(Paired& poses) {
    Paired rows = rows_of(false);
    bool is_changed = add(remove_frozen(rows, *estimate_, false));
    PartedPairs parted{rows, {}};
    const double before = position_error(rows, similarity(rows));
    std::optional<InputFinding> jumps = remove_jumps(rows, false);
    const double left = position_error(rows, similarity(rows));
    constexpr double kMostAfter = 0.5, kExplained = 0.25;
    const bool is_explained = jumps && left < kExplained * before;
    if (!is_explained && !agreement(thinned(rows)).is_good()) {
      std::optional<InputFinding> maps = join_maps(parted, *estimate_, kMostAfter);
      if (!maps && !jumps) maps = join_scales(parted, *estimate_);
      if (maps && (!jumps || position_error(parted) < kMostAfter * left)) {
        jumps = std::move(maps);
        rows = std::move(parted.pairs);
      }
    }
    is_changed |= add(std::move(jumps));
    if (!is_changed && !agreement(poses).is_good()) {
      rows = rows_of(true);
      is_changed = add(remove_frozen(rows, *reference_, true));
      is_changed |= add(remove_jumps(rows, true));
    }
    if (is_changed) poses = thinned(rows);
  }

  static Paired thinned(const Paired& rows) {
    Paired out;
    const std::size_t step = even_step(rows.estimate.size(), kMostPoses);
    for (std::size_t i = 0; i < rows.estimate.size(); i += step) {
      out.reference.push_back(rows.reference[i]);
      out.estimate.push_back(rows.estimate[i]);
    }
    return out;
  }

  /// Notes it if they are not.
  bool are_enough(const Paired& poses) {
    if (poses.estimate.size() >= kFewestCommonPoses) return true;
    out_.unchecked.push_back(
        fmt::format("{}: poses of the estimate in the reference's time: {}, expected at least {}",
                    kChecksOfPoses,
                    poses.estimate.size(),
                    kFewestCommonPoses));
    return false;
  }

  /// Between few poses of the reference, its motion is not known.
  bool has_enough_of_reference() {
    const std::size_t count = common_poses(*estimate_, *reference_, -offset_).estimate.size();
    if (count >= kFewestCommonPoses) return true;
    out_.unchecked.push_back(
        fmt::format("{}: poses of the reference in the estimate's time: {}, expected at least {}",
                    kChecksOfPoses,
                    count,
                    kFewestCommonPoses));
    return false;
  }

  void check_poses() {
    Paired poses = common_poses(*reference_, *estimate_, offset_);
    if (!are_enough(poses) || !has_enough_of_reference()) return;
    const bool is_reference = is_at_rest(*reference_);
    if (is_reference || is_at_rest(*estimate_)) {
      out_.unchecked.push_back(fmt::format("{}: the {} moves by less than {:g} times its noise",
                                           kChecksOfPoses,
                                           is_reference ? "reference" : "estimate",
                                           kLeastOfNoise));
      return;
    }
    out_.has_checked = true;
    repair_parts(poses);
    if (!are_enough(poses)) return;
    if (!agreement(poses).has_rotations) {
      note_constant_rotation(largest_rotation_angle(poses.reference),
                             largest_rotation_angle(poses.estimate));
    }
    if (has_rows_of_degrees(poses)) return;
    while (add(apply_best_repair(poses, out_.findings, lacks_rotations(*reference_)))) {
    }
    if (out_.findings.empty() && !agreement(poses).is_good()) add(check_shear(poses));
    check_recording(poses);
  }

  /// Metres and degrees differ by a factor of 1e5, which is otherwise taken for a scale.
  bool has_rows_of_degrees(const Paired& poses) {
    constexpr double kLeastFactor = 1e4;
    const double scale = std::cbrt(similarity(poses).linear().determinant());
    const bool is_usual = scale * kLeastFactor > 1.0 && scale < kLeastFactor;
    return !is_usual && !agreement(poses).is_good() &&
           add(check_rows(*reference_, *estimate_, has_stamps_));
  }

  /// A finding only if the other file rotates. Files of positions are meant to have no rotations.
  void note_constant_rotation(double of_reference, double of_estimate) {
    const auto [smaller, larger] = std::minmax(of_reference, of_estimate);
    const char* const name = of_reference <= kLeastRotation ? "reference" : "estimate";
    out_.unchecked.push_back(
        fmt::format("quaternion order, inverted poses, axes: the {} does not "
                    "rotate by {:g} rad",
                    name,
                    kLeastRotation));
    const bool has_positions_only = lacks_rotations(*reference_) || lacks_rotations(*estimate_);
    if (has_positions_only || smaller > kNoNoise || larger < 2.0 * kLeastRotation) return;
    out_.findings.push_back({Fault::constant_rotation,
                             fmt::format("the {}'s rotation is constant while "
                                         "the other file rotates by {:.0f} deg",
                                         name,
                                         kDegrees * larger),
                             "write the file with rotations, or use position "
                             "errors only (eval -r trans_part)",
                             1.0,
                             larger});
  }

  /// Nothing agrees, whatever is repaired: replaces all other findings.
  void check_recording(const Paired& repaired) {
    constexpr double kPosition = 0.4, kAlone = 0.7;
    const Agreement left = agreement(repaired);
    const double error = position_error(repaired, similarity(repaired));
    const double position = error / left.spread;
    if (left.turning < kAlone || position < (left.has_rotations ? kPosition : kAlone)) return;
    const double correlation = speed_correlation(*reference_, *estimate_, offset_);
    const double confidence = std::min(1.0, position) * (1.0 - correlation);
    if (correlation > kLeastCorrelation || confidence < kLeastConfidence) return;
    out_.findings.clear();
    if (add(check_rows(*reference_, *estimate_, has_stamps_))) return;
    if (!has_stamps_ && reference_->size() != estimate_->size()) {
      out_.unchecked.push_back(fmt::format(
          "{}: the files have no stamps and different numbers of rows", kChecksOfPoses));
      return;
    }
    if (add(check_rate(*reference_, *estimate_))) return;
    add(InputFinding{
        Fault::wrong_recording,
        fmt::format("no repair makes the files agree: after alignment with scale, the position "
                    "error is {:.3g} m, {:.0f} % of the reference's spread; correlation of speeds "
                    "{:.2f}",
                    error,
                    100.0 * position,
                    correlation),
        "give files of the same recording",
        confidence,
        position});
  }

  const Trajectory* reference_;
  const Trajectory* estimate_;
  Trajectory changed_;  ///< with stamps in seconds
  bool has_stamps_;
  double offset_ = 0.0;  ///< found [s]
  Diagnosis out_;
};

}  // namespace

Diagnosis diagnosis(const Trajectory& reference,
                    const Trajectory& estimate,
                    const std::string& reference_name,
                    const std::string& estimate_name,
                    bool has_stamps) {
  return PairDiagnosis(reference, estimate, has_stamps).run(reference_name, estimate_name);
}

}  // namespace loopbench::metrics
