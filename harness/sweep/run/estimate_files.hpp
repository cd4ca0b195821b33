/// Estimates of cells at full length, written as TUM files while a sweep runs.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

#include "datasets/core/curve.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/core/sequence.hpp"
#include "datasets/derive/planar.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"

namespace loopbench::harness {

inline std::filesystem::path& estimate_folder() {
  static std::filesystem::path folder;
  return folder;
}

/// FOLDER/KEY-TIMES.txt, for the cell with this key.
inline std::filesystem::path estimate_file(const std::filesystem::path& folder,
                                           const std::string& key,
                                           metrics::Times times) {
  return folder / (key + "-" + to_text(times) + ".txt");
}

inline std::filesystem::path unnamed_file(const Cell& cell, metrics::Times times) {
  return estimate_file(estimate_folder(), "cell-" + std::to_string(cell.index), times);
}

inline constexpr metrics::Times kAllTimes[] = {metrics::Times::keyframes, metrics::Times::dense};

/// Sets the folder for this process and its workers; empty: estimates are not written. Call before
/// cells run.
inline void set_estimate_folder(const std::filesystem::path& folder) {
  if (!folder.empty()) std::filesystem::create_directories(folder);
  estimate_folder() = folder;
}

/// FOLDER/reference-CONTENT.txt, for sequences with this content_of().
inline std::filesystem::path reference_file(const std::filesystem::path& folder,
                                            const std::string& content) {
  return folder / ("reference-" + content + ".txt");
}

/// Writes the reference of the sequence, see reference_file(), and the estimate of a cell in its
/// own world frame: at the keyframes and, if the sweep evaluates densely, at the reference's stamps
/// (minus the offset of the first protocol) inside its span. Every digit is written. Does nothing
/// without a folder. Throws InputError.
inline void save_estimate(const Cell& cell,
                          const Sweep& sweep,
                          const Sequence& sequence,
                          const Curve& curve) {
  if (estimate_folder().empty()) return;
  const Rotation body_from_file = sequence.provenance.file_body_from_body.rotation.conjugate();
  const auto of_file = [&](Trajectory poses) {
    change_body(poses, body_from_file);
    return poses;
  };
  const std::filesystem::path reference = reference_file(estimate_folder(), content_of(sequence));
  if (!sequence.reference.empty() && !std::filesystem::exists(reference)) {
    write_trajectory(reference, {.poses = of_file(sequence.reference)}, Format::tum);
  }
  write_tum(unnamed_file(cell, metrics::Times::keyframes),
            of_file(curve.sample(stamps(sequence.problem.keyframes))));
  if (std::ranges::count(sweep.times, metrics::Times::dense) == 0) return;
  std::vector<double> times;
  for (const StampedPose& pose : sequence.reference) {
    const double time = pose.stamp - sweep.protocols.front().rules.offset;
    if (time >= curve.start() && time <= curve.end()) times.push_back(time);
  }
  if (!times.empty()) {
    write_tum(unnamed_file(cell, metrics::Times::dense), of_file(curve.sample(times)));
  }
}

/// Gives the files of a cell their final names, see estimate_file(). Does nothing if there are
/// none.
inline void keep_estimate(const Cell& cell, const std::string& key) {
  if (estimate_folder().empty()) return;
  for (const metrics::Times times : kAllTimes) {
    std::error_code absent;
    std::filesystem::rename(
        unnamed_file(cell, times), estimate_file(estimate_folder(), key, times), absent);
  }
}

}  // namespace loopbench::harness
