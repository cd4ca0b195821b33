/// Reading and writing of trajectory files. Errors state the file, the line and the violated rule.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/columns/reading.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Reads a trajectory in any known format. The file can be compressed, a pipe, or `-` for standard
/// input; a trajectory in a bag is `bag:FILE#/topic`, `bag:FILE#tf:PARENT.CHILD`, or the bag's file
/// if it has only one. For g2o these are the vertices, or the composed edges of a file without
/// vertices, with stamp = id * period. Quaternions within 1e-2 of unit norm are normalised. Throws
/// InputError `file:line: what was found, what was expected`. O(n).
Trajectory read_trajectory(const std::filesystem::path& file, const ReadOptions& options = {});

/// What a reader changed in rows, and in how many, or by how much.
struct RowChange {
  enum class Kind { dropped_rows, sorted_rows, repeated_stamps, normalised_rotations };
  Kind kind = Kind::dropped_rows;
  double value = 0.0;
};
std::vector<RowChange> row_changes(const ReadFindings& findings);
std::string to_text(const RowChange& change);

/// What the readers chose and ignored, for notes.
std::vector<std::string> reading_choices(const ReadFindings& findings);

/// The texts of both.
std::vector<std::string> reading_notes(const ReadFindings& findings);

/// Detects the format from the content. Throws InputError if it is unknown.
Format detect_format(const std::filesystem::path& file);

/// Whether the rows of a file of this format have no stamps, so that they take those of a times
/// file.
bool takes_times(const std::filesystem::path& file, Format format);

/// Whether the rows have stamps that can be numbers of frames: small whole numbers. They take those
/// of a times file if no other file needs it.
bool can_take_times(const std::filesystem::path& file, Format format);

/// Why two files have no common time; empty if they have: stamps, ids, or equal numbers of rows.
struct FileClock {
  std::string name;
  Clock clock = Clock::stamps;
  std::size_t rows = 0;
};
std::string why_no_common_time(const FileClock& one, const FileClock& other);

/// Writes a TUM file. Doubles are printed so that reading them is bit-identical; `comments` become
/// `# ` lines at the top. Throws InputError for an invalid trajectory and if the file cannot be
/// written.
void write_tum(const std::filesystem::path& file,
               const Trajectory& trajectory,
               const std::vector<std::string>& comments = {});

}  // namespace loopbench
