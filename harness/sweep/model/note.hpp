/// A fact about the input or the result of a run that a reader of its numbers should know.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace loopbench::harness {

enum class NoteKind {
  dataset,          ///< remark of a dataset: skipped rows, units, tracking losses
  method,           ///< remark of a method
  omitted,          ///< further notes that are not kept
  oracle,           ///< estimate or frames equal the reference
  body,             ///< the motion indicates another body than the reference's
  detection,        ///< detected loops compared with the reference
  alignment,        ///< alignment that a dataset sets for every protocol
  plane,            ///< alignment in a plane, or why not
  low_coverage,     ///< less than half of the poses are evaluated
  unpaired,         ///< less than half of the poses have a partner
  few_pairs,        ///< the alignment fits the errors
  association,      ///< stamps differ within pairs
  tracking_gaps,    ///< bridged without a measurement
  datum,            ///< both files are in the same frame
  reference_error,  ///< error of the reference itself
  paired_rows,      ///< rows are paired, because there are no stamps
  undefined,        ///< a score of the protocol that the data do not define
  common_times,     ///< evaluated over the times that all estimates cover
  damaged_file,
  nondeterministic,  ///< runs on equal input gave different trajectories
  // What reading changed, in the order of RowChange::Kind.
  dropped_rows,
  sorted_rows,
  repeated_stamps,
  normalised_rotations,
  // Findings of `doctor`, with the names of metrics::Fault.
  time_offset,
  stamp_unit,
  no_overlap,
  missing_poses,
  wrong_recording,
  row_order,
  relative_poses,
  degrees,
  sheared,
  jumps,
  new_map,
  frozen,
  scale_change,
  constant_rotation,
  quaternion_order,
  inverted_poses,
  axes,
  mirrored,
  other_body,
  scale,
  swapped,
  loop_stamps,
  closure_direction,
  closure_convention,
  placeholders,
  closure_gap,
  odometry_step,
  information
};

inline auto choices(NoteKind) {
  using enum NoteKind;
  return std::array{std::pair{"dataset", dataset},
                    std::pair{"method", method},
                    std::pair{"omitted", omitted},
                    std::pair{"oracle", oracle},
                    std::pair{"body", body},
                    std::pair{"detection", detection},
                    std::pair{"alignment", alignment},
                    std::pair{"plane", plane},
                    std::pair{"low_coverage", low_coverage},
                    std::pair{"unpaired", unpaired},
                    std::pair{"few_pairs", few_pairs},
                    std::pair{"association", association},
                    std::pair{"tracking_gaps", tracking_gaps},
                    std::pair{"datum", datum},
                    std::pair{"reference_error", reference_error},
                    std::pair{"paired_rows", paired_rows},
                    std::pair{"undefined", undefined},
                    std::pair{"common_times", common_times},
                    std::pair{"damaged_file", damaged_file},
                    std::pair{"nondeterministic", nondeterministic},
                    std::pair{"dropped_rows", dropped_rows},
                    std::pair{"sorted_rows", sorted_rows},
                    std::pair{"repeated_stamps", repeated_stamps},
                    std::pair{"normalised_rotations", normalised_rotations},
                    std::pair{"time_offset", time_offset},
                    std::pair{"stamp_unit", stamp_unit},
                    std::pair{"no_overlap", no_overlap},
                    std::pair{"missing_poses", missing_poses},
                    std::pair{"wrong_recording", wrong_recording},
                    std::pair{"row_order", row_order},
                    std::pair{"relative_poses", relative_poses},
                    std::pair{"degrees", degrees},
                    std::pair{"sheared", sheared},
                    std::pair{"jumps", jumps},
                    std::pair{"new_map", new_map},
                    std::pair{"frozen", frozen},
                    std::pair{"scale_change", scale_change},
                    std::pair{"constant_rotation", constant_rotation},
                    std::pair{"quaternion_order", quaternion_order},
                    std::pair{"inverted_poses", inverted_poses},
                    std::pair{"axes", axes},
                    std::pair{"mirrored", mirrored},
                    std::pair{"other_body", other_body},
                    std::pair{"scale", scale},
                    std::pair{"swapped", swapped},
                    std::pair{"loop_stamps", loop_stamps},
                    std::pair{"closure_direction", closure_direction},
                    std::pair{"closure_convention", closure_convention},
                    std::pair{"placeholders", placeholders},
                    std::pair{"closure_gap", closure_gap},
                    std::pair{"odometry_step", odometry_step},
                    std::pair{"information", information}};
}

enum class Severity {
  info,     ///< how a number was computed
  caution,  ///< limits what a number means
  decisive  ///< can change a conclusion: stands above every verdict
};
inline auto choices(Severity) {
  return std::array{std::pair{"info", Severity::info},
                    std::pair{"caution", Severity::caution},
                    std::pair{"decisive", Severity::decisive}};
}

/// A number that a note states.
struct Quantity {
  std::string name;
  double value = 0.0;
  std::string unit = {};

  friend bool operator==(const Quantity&, const Quantity&) = default;
};

/// The option of a Remedy that is a key of the config.
inline constexpr const char* kConfigProtocol = "protocol";

/// What removes the cause: an option with a value, "--offset" and "-0.0500"; a key of the config,
/// kConfigProtocol and "{offset: -0.0500}"; or words.
struct Remedy {
  std::string option = {};
  std::string value = {};

  friend bool operator==(const Remedy&, const Remedy&) = default;
};

struct Note {
  NoteKind kind = NoteKind::dataset;
  Severity severity = Severity::info;
  std::string subject = {};  ///< file, closure or edge; empty: the run, or the cell of a method
  std::vector<Quantity> numbers = {};
  Remedy remedy = {};
  std::string detail = {};  ///< words of a dataset, method or program; evidence of a finding

  /// The number of that name; 0: it is not stated.
  double number(const std::string& name) const {
    for (const Quantity& each : numbers) {
      if (each.name == name) return each.value;
    }
    return 0.0;
  }

  friend bool operator==(const Note&, const Note&) = default;
};

/// Whether it is about rows that reading a file changed.
inline bool is_of_reading(NoteKind kind) {
  return kind >= NoteKind::dropped_rows && kind <= NoteKind::normalised_rotations;
}

/// Whether `doctor` finds notes of this kind.
inline bool is_of_doctor(NoteKind kind) { return kind >= NoteKind::time_offset; }

}  // namespace loopbench::harness
