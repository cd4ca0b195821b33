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

/// `automatic` recognises the format by content, never by extension. Stamps of tum are seconds, or
/// nanoseconds where they are 1e16 or more, or where the first two are whole numbers at least 1e5
/// apart (clocks of simulators start at 0).
enum class Format { automatic, tum, kitti, euroc, g2o };
inline auto choices(Format) {
  return std::array{std::pair{"auto", Format::automatic},
                    std::pair{"tum", Format::tum},
                    std::pair{"kitti", Format::kitti},
                    std::pair{"euroc", Format::euroc},
                    std::pair{"g2o", Format::g2o}};
}

/// What to do with a pose whose stamp equals the one before it, which some published files hold:
/// TUM's and evo's own readers keep the last.
/// Stamps that go back are always refused, and so are repeats in a times file.
enum class Repeats { refuse, keep_first, keep_last };
inline auto choices(Repeats) {
  return std::array{std::pair{"refuse", Repeats::refuse},
                    std::pair{"keep_first", Repeats::keep_first},
                    std::pair{"keep_last", Repeats::keep_last}};
}

/// What a reader mended silently, of tum and euroc.
struct ReadFindings {
  double off_unit = 0.0;     ///< largest | |q| - 1 | before normalising
  std::size_t repeated = 0;  ///< poses left out for another of the same stamp
};

struct ReadOptions {
  Format format = Format::automatic;
  /// Seconds, one per line, for KITTI poses; without it KITTI and g2o poses are `period` apart.
  std::optional<std::filesystem::path> times;
  double period = 0.1;  ///< [s], KITTI's 10 Hz
  Repeats repeats = Repeats::refuse;
  ReadFindings* findings = nullptr;  ///< filled when given
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
