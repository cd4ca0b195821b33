/// Reading and writing trajectory files: strict, and each refusal names file, line and rule.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// What to do with a pose whose stamp equals the one before it, which some published files hold.
/// Stamps that go back are always refused.
enum class Repeats { refuse, keep_first };
inline auto choices(Repeats) {
  return std::array{std::pair{"refuse", Repeats::refuse},
                    std::pair{"keep_first", Repeats::keep_first}};
}

struct ReadOptions {
  Format format = Format::automatic;
  /// Seconds, one per line, for KITTI poses; without it KITTI and g2o poses are `period` apart.
  std::optional<std::filesystem::path> times;
  double period = 0.1;  ///< [s], KITTI's 10 Hz
  Repeats repeats = Repeats::refuse;
};

/// A trajectory from any known format. For g2o: its vertices, or its consecutive edges chained when
/// it has none; stamp = id * period. Quaternions within 1e-2 of unit length are normalised.
/// Throws InputError `file:line: what and what was expected`. O(n).
Trajectory read_trajectory(const std::filesystem::path& file, const ReadOptions& options = {});

/// The format a file's content shows, or InputError.
Format recognise(const std::filesystem::path& file);

/// Writers print every double so that it reads back as the same bits; `comments` become `# ` lines
/// on top. They throw InputError for a file that cannot be written and for a broken trajectory.
void write_tum(const std::filesystem::path& file,
               const Trajectory& trajectory,
               const std::vector<std::string>& comments = {});

/// 12 columns a pose; stamps go to `times`, one a line, when it is given. Rotations travel as
/// matrices, so they read back to rounding (1e-15), not to the bit.
void write_kitti(const std::filesystem::path& file,
                 const Trajectory& trajectory,
                 const std::optional<std::filesystem::path>& times = std::nullopt);

}  // namespace loopbench
