/// A trajectory with all that its file states, for conversion without loss.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench {

struct TrajectoryFile {
  Trajectory poses;
  /// Exact stamps, one per pose: a double has a resolution of 240 ns in 2026. Empty if the file has
  /// no stamps, or more than nine decimals.
  std::vector<std::int64_t> nanoseconds = {};
  /// Stated covariances, one per pose (datasets/core/covariance.hpp). Empty if the file has none.
  std::vector<Matrix6> covariances = {};
  Format format = Format::tum;
  bool has_stamps = true;  ///< false: stamps are multiples of the period
};

/// Reads like read_trajectory(), with exact stamps and covariances. O(n).
TrajectoryFile read_trajectory_file(const std::filesystem::path& file,
                                    const ReadOptions& options = {});

/// Whether files of this format contain the covariances of `file`: csv; tum of poses with rotation.
/// False if there are none.
bool has_covariances(const TrajectoryFile& file, Format format);

/// Whether write_trajectory() writes files of this format.
bool can_write(Format format);

/// Keeps the poses with these indices, in their order. O(indices).
TrajectoryFile selected(const TrajectoryFile& file, const std::vector<std::size_t>& indices);

/// Writes tum, kitti (and the stamps to `times`, one per line, if given), euroc, g2o (vertices with
/// ids 0, 1, ...) or csv. tum and csv contain covariances, if stated: see has_covariances().
/// Positions and quaternions are printed so that reading them is bit-identical, and exact stamps
/// with all digits; euroc rounds other stamps to nanoseconds. `-` is standard output. Throws
/// InputError for an invalid trajectory and if the file cannot be written.
void write_trajectory(const std::filesystem::path& file,
                      const TrajectoryFile& trajectory,
                      Format format,
                      const std::optional<std::filesystem::path>& times = std::nullopt);

/// The same as tum, with `comments` as `# ` lines at the top.
void write_tum(const std::filesystem::path& file,
               const TrajectoryFile& trajectory,
               const std::vector<std::string>& comments);

}  // namespace loopbench
