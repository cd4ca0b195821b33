/// The trajectory formats: one entry for each, in the source of its name.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "datasets/columns/reading.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/core/trajectory.hpp"
#include "datasets/files/text_writer.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {

/// What a format can contain apart from poses.
struct FormatContents {
  bool positions = false;             ///< rows without rotation
  bool covariances = false;           ///< of poses
  bool position_covariances = false;  ///< of rows without rotation
};

/// One format. Files of text have `guess` and `read`, others `guess_file` and `read_file`.
struct FormatEntry {
  Format format = Format::automatic;
  /// Whether a line of data has this format. The first entry of formats() that fits is taken. Null:
  /// a header decides.
  bool (*guess)(const TextFile& file, const Line& line) = nullptr;
  /// Reads all rows behind the header, as the options state (for_each_row(), StampOrder). Sets
  /// file.repaired.clock if the stamps of the poses are numbers of rows or frames: the caller
  /// replaces them by times. Throws InputError.
  Trajectory (*read)(TextFile& file, const ReadOptions& options) = nullptr;
  /// Whether the rows have no stamps, or numbers instead. Null: never.
  bool (*takes_times)(const TextFile& file) = nullptr;
  /// The text of a file, whose name is for messages. Throws InputError. Null: cannot be written.
  TextWriter (*write)(const TrajectoryFile& file, const std::string& name) = nullptr;
  FormatContents contents = {};

  bool (*guess_file)(const std::filesystem::path& file) = nullptr;
  TrajectoryFile (*read_file)(const std::filesystem::path& file,
                              const ReadOptions& options) = nullptr;
};

/// All formats, in the order in which they are guessed.
std::span<const FormatEntry> formats();

/// The entry of a format other than `automatic`.
const FormatEntry& entry_of(Format format);

FormatEntry bag_format();
FormatEntry g2o_format();
FormatEntry json_graph_format();  ///< also of format g2o, behind g2o_format()
FormatEntry kitti_format();
FormatEntry euroc_format();
FormatEntry tum_format();
FormatEntry csv_format();
FormatEntry json_format();
FormatEntry npy_format();
FormatEntry log_format();
FormatEntry frames_format();

}  // namespace loopbench
