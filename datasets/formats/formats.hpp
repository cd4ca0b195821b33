/// Reading and writing of trajectory files. Errors state the file, the line and the violated rule.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"
#include "datasets/formats/geodetic.hpp"

namespace loopbench {

/// `automatic` detects the format from the content, not from the file extension. Stamps of tum are
/// seconds, or nanoseconds if they are 1e16 or more or if the first two are whole numbers at least
/// 1e5 apart and below 1e15 (clocks of simulators start at 0; microseconds since 1970 are above). A
/// header row is skipped; csv is a table whose
/// header names time, position and quaternion, in any order. bag is a ROS bag (datasets/bags).
enum class Format { automatic, tum, kitti, euroc, g2o, csv, bag };
inline auto choices(Format) {
  return std::array{std::pair{"auto", Format::automatic},
                    std::pair{"tum", Format::tum},
                    std::pair{"kitti", Format::kitti},
                    std::pair{"euroc", Format::euroc},
                    std::pair{"g2o", Format::g2o},
                    std::pair{"csv", Format::csv},
                    std::pair{"bag", Format::bag}};
}

/// Handling of a pose with the same stamp as the previous one, which occurs in published files. The
/// reader of TUM keeps the last, evo all. Decreasing stamps, and repeated stamps in a times file,
/// are always rejected. `keep_all` is not a choice of users, because only the association of evo
/// accepts equal stamps.
enum class Repeats { refuse, keep_first, keep_last, keep_all };
inline auto choices(Repeats) {
  return std::array{std::pair{"refuse", Repeats::refuse},
                    std::pair{"keep_first", Repeats::keep_first},
                    std::pair{"keep_last", Repeats::keep_last}};
}

/// Corrections made by the readers of tum, euroc, csv and bags.
struct ReadFindings {
  double off_unit = 0.0;                      ///< maximum | |q| - 1 | before normalisation
  std::size_t repeated = 0;                   ///< poses dropped because of a repeated stamp
  std::string damage = {};                    ///< what is missing of a damaged bag; empty: intact
  std::size_t without_fix = 0;                ///< rows of NavSatFix without a position
  std::optional<GeodeticOrigin> origin = {};  ///< of positions converted from WGS 84
  /// Stated covariances, one per pose (datasets/core/covariance.hpp); empty: none. Those of
  /// positions without rotation have zeros for the rotation.
  std::vector<Matrix6> covariances = {};
  bool assumed_axes = false;  ///< the file does not state their convention
};

struct ReadOptions {
  Format format = Format::automatic;
  /// Times file for KITTI poses, one time per line [s]. Without it stamps are multiples of
  /// `period`.
  std::optional<std::filesystem::path> times;
  double period = 0.1;  ///< between poses of KITTI and consecutive ids of g2o [s]
  Repeats repeats = Repeats::refuse;
  /// Accepts positions without rotations (lacks_rotations()): rows `stamp x y z`, zero quaternions,
  /// tables without a quaternion, PointStamped, NavSatFix.
  bool positions = false;
  /// Origin of local coordinates for latitude, longitude and height; default: the first position.
  std::optional<GeodeticOrigin> origin = {};
  ReadFindings* findings = nullptr;  ///< written unless null
};

/// Reads a trajectory in any known format. The file can be compressed, a pipe, or `-` for standard
/// input; a trajectory in a bag is `bag:FILE#/topic`, `bag:FILE#tf:PARENT.CHILD`, or the bag's file
/// if it has only one. For g2o these are the vertices, or the composed edges of a file without
/// vertices, with stamp = id * period. Quaternions within 1e-2 of unit norm are normalised. Throws
/// InputError `file:line: what was found, what was expected`. O(n).
Trajectory read_trajectory(const std::filesystem::path& file, const ReadOptions& options = {});

/// Detects the format from the content. Throws InputError if it is unknown.
Format detect_format(const std::filesystem::path& file);

/// Writes a TUM file. Doubles are printed so that reading them is bit-identical; `comments` become
/// `# ` lines at the top. Throws InputError for an invalid trajectory and if the file cannot be
/// written.
void write_tum(const std::filesystem::path& file,
               const Trajectory& trajectory,
               const std::vector<std::string>& comments = {});

}  // namespace loopbench
