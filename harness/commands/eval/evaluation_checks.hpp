/// What `eval` remarks about an evaluation: the diagnosis, the frame and accuracy of the reference.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "datasets/core/fields.hpp"
#include "harness/commands/eval/common_rows.hpp"
#include "harness/commands/eval/file_evaluation.hpp"
#include "harness/commands/eval/pairing_remedies.hpp"
#include "harness/sweep/run/evaluation_notes.hpp"
#include "metrics/checks/diagnostics.hpp"
#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/doctor/finding.hpp"
#include "metrics/errors/ate.hpp"

namespace loopbench::harness {

/// The error without alignment, if the files are in one datum: as stated (converted from WGS 84
/// about one origin), or frames that differ by less than a tenth of the reference's size, of which
/// the alignment hides at least half; otherwise empty. O(n).
inline std::optional<Note> shared_datum(const metrics::Evaluation& evaluation, bool is_one_datum) {
  constexpr double kNear = 0.1, kHidden = 0.5;
  const metrics::Alignment& fit = evaluation.alignment;
  const bool is_projected = evaluation.protocol.project != metrics::ProjectionPlane::none;
  if (fit.type == metrics::Align::none || is_projected) return std::nullopt;
  const Pose estimate_from_reference = fit.reference_from_estimate.inverse();
  const auto& pairs = evaluation.reference;
  Vector3 mean = Vector3::Zero();
  for (const auto& [stamp, pose] : pairs) {
    mean += pose.translation / static_cast<double>(pairs.size());
  }
  double size = 0.0, aligned = 0.0, unaligned = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Vector3& expected = pairs[i].world_from_body.translation;
    const Vector3& found = evaluation.estimate[i].world_from_body.translation;
    size += (expected - mean).squaredNorm();
    aligned += (found - expected).squaredNorm();
    unaligned += (estimate_from_reference * found / fit.scale - expected).squaredNorm();
  }
  const bool is_near =
      unaligned <= kNear * kNear * size && aligned <= kHidden * kHidden * unaligned;
  if (!is_one_datum && !is_near) return std::nullopt;
  const auto count = static_cast<double>(pairs.size());
  return Note{.kind = NoteKind::datum,
              .severity = Severity::caution,
              .numbers = {{"unaligned", std::sqrt(unaligned / count), "m"},
                          {"aligned", std::sqrt(aligned / count), "m"},
                          {"stated", is_one_datum ? 1.0 : 0.0}},
              .remedy = {"--align", "none"},
              .detail = to_text(fit.type)};
}

/// Whether the ATE exceeds the reference's own error of `sigma` [m] per axis; empty for 0. O(n).
inline std::optional<Note> reference_error(const metrics::Evaluation& evaluation, double sigma) {
  if (sigma == 0.0) return std::nullopt;
  const double own = std::sqrt(3.0) * sigma;
  const double error = metrics::ate(evaluation, {}).front().statistics.rmse;
  return Note{.kind = NoteKind::reference_error,
              .severity = Severity::caution,
              .numbers = {{"error", own, "m"},
                          {"sigma", sigma, "m"},
                          {"ate", error, "m"},
                          {"without", std::sqrt(std::max(0.0, error * error - own * own)), "m"}}};
}

/// What pairs more poses, if less than half of the file with fewer are paired; otherwise empty.
inline std::optional<Note> few_pairs(const metrics::Evaluation& evaluation,
                                     const Trajectory& reference,
                                     const Trajectory& estimate) {
  const auto& [pairs, possible, span, bridged] = evaluation.coverage;
  if (2 * pairs >= std::min(possible, reference.size())) return std::nullopt;
  const std::string remedies = pairing_remedies(reference, estimate, evaluation.protocol);
  if (remedies.empty()) return std::nullopt;
  return Note{.kind = NoteKind::unpaired,
              .severity = Severity::decisive,
              .numbers = {{"pairs", static_cast<double>(pairs)},
                          {"possible", static_cast<double>(possible)}},
              .detail = remedies};
}

/// A note if the files have no stamps, and therefore pairs of rows; otherwise empty.
inline std::optional<Note> paired_rows(const metrics::Evaluation& evaluation,
                                       const FileClock& one,
                                       const FileClock& other) {
  const bool by_rows = one.clock == Clock::rows && other.clock == Clock::rows;
  if (!by_rows || one.rows != other.rows || evaluation.protocol.offset != 0.0) {
    return std::nullopt;
  }
  return Note{.kind = NoteKind::paired_rows,
              .numbers = {{"rows", static_cast<double>(one.rows)},
                          {"pairs", static_cast<double>(evaluation.coverage.pairs)}}};
}

/// Whether a finding of the doctor explains errors that another body would explain, too.
inline bool explains_other_body(const Note& note) {
  using enum NoteKind;
  constexpr std::array kKinds{time_offset,
                              constant_rotation,
                              inverted_poses,
                              quaternion_order,
                              axes,
                              mirrored,
                              wrong_recording};
  return std::ranges::count(kKinds, note.kind) > 0;
}

/// Poses with the increasing stamps that the doctor needs: the first pose of each stamp, or
/// multiples of the period for the rows. Copies into `kept` only if some change.
inline const Trajectory& for_doctor(const EvaluatedFile& file, bool by_index, Trajectory& kept) {
  const Trajectory& poses = file.poses;
  if (by_index) {
    kept = poses;
    const std::vector<std::size_t> rows = row_numbers(file);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      kept[i].stamp = static_cast<double>(rows[i]) * ReadOptions{}.period;
    }
    return kept;
  }
  const auto are_equal = [](const auto& a, const auto& b) { return a.stamp == b.stamp; };
  if (std::ranges::adjacent_find(poses, are_equal) == poses.end()) return poses;
  kept = poses;
  kept.erase(std::unique(kept.begin(), kept.end(), are_equal), kept.end());
  return kept;
}

/// Which alignment was taken, if a trajectory is in one plane and the protocol decides. O(n).
inline std::string plane_text(const metrics::Evaluation& evaluation) {
  const metrics::Align align = evaluation.protocol.align;
  const bool is_fitted = align == metrics::Align::se3 || align == metrics::Align::sim3;
  if (evaluation.protocol.planar == Planar::no || !is_fitted) return "";
  if (evaluation.protocol.planar == Planar::yes) {
    return std::string("planar, as set: both trajectories were moved to their planes") +
           (evaluation.planar
                ? " and aligned there"
                : ", but all six degrees of freedom are aligned, because the "
                  "axes of their bodies (for positions, of their world frames) differ");
  }
  if (evaluation.planar) {
    return "planar: both trajectories are in one plane, so they are aligned in x, y and yaw "
           "(--planar no aligns all six)";
  }
  const bool is_reference = motion_plane(evaluation.reference).has_value();
  const bool is_estimate = motion_plane(evaluation.estimate).has_value();
  if (!is_reference && !is_estimate) return "";
  const char* which = "the estimate is in one plane, but the reference is not";
  if (is_reference) which = "the reference is in one plane, but the estimate is not";
  if (is_reference && is_estimate) {
    which = "both trajectories are in one plane, but the axes of their bodies differ";
  }
  return std::string("spatial: ") + which + ", so all six degrees of freedom are aligned";
}

/// Sets diagnosis, notes and other_body. O(n log n).
inline void add_checks(EvaluationResult& out,
                       const metrics::Evaluation& evaluation,
                       const EvaluatedFile& reference,
                       const EvaluatedFile& estimate,
                       const EvaluatedSweep& files) {
  out.diagnosis = metrics::diagnostics(evaluation, {});
  out.notes = evaluation_notes(reference.poses, evaluation);
  for (const std::optional<Note>& note :
       {shared_datum(evaluation, reference.findings.origin && estimate.findings.origin),
        reference_error(evaluation, files.arguments.reference_sigma),
        paired_rows(evaluation, reference.clock, estimate.clock),
        few_pairs(evaluation, reference.poses, estimate.poses)}) {
    if (note) out.notes.push_back(*note);
  }
  if (const std::string plane = plane_text(evaluation); !plane.empty()) {
    out.notes.push_back({.kind = NoteKind::plane, .detail = plane});
  }
  const double off_unit = std::max(reference.findings.off_unit, estimate.findings.off_unit);
  for (metrics::Score& score : out.diagnosis) {
    // Readers normalise, so the value is that of the files.
    if (score.relation == "off_unit") score = metrics::single("off_unit", "", "1", off_unit);
  }
  const std::size_t left_out = reference.findings.repeated + estimate.findings.repeated;
  out.diagnosis.push_back(metrics::single("left_out", "", "1", static_cast<double>(left_out)));
  if (const auto offset = metrics::extrinsic_offset(evaluation, {})) {
    out.other_body = metrics::other_body(*offset, pose_of(files.body));
  }
}

}  // namespace loopbench::harness
