/// Reading and writing trajectory files: strict, and each refusal names file, line and rule.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// `automatic` recognises the format by content, never by extension.
enum class Format { automatic, tum, kitti, euroc, g2o };
inline auto choices(Format) {
  return std::array{std::pair{"auto", Format::automatic},
                    std::pair{"tum", Format::tum},
                    std::pair{"kitti", Format::kitti},
                    std::pair{"euroc", Format::euroc},
                    std::pair{"g2o", Format::g2o}};
}

struct ReadOptions {
  Format format = Format::automatic;
  /// Seconds, one per line, for KITTI poses; without it KITTI and g2o poses are `period` apart.
  std::optional<std::filesystem::path> times;
  double period = 0.1;  ///< [s], KITTI's 10 Hz
};

/// A trajectory from any known format (for g2o: its vertices, stamp = id * period).
/// Throws InputError `file:line: what and what was expected`. O(n).
Trajectory read_trajectory(const std::filesystem::path& file, const ReadOptions& options = {});

/// The format a file's content shows, or InputError.
Format recognise(const std::filesystem::path& file);

}  // namespace loopbench
