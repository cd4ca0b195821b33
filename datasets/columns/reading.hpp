/// Options and findings of all readers.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/columns/geodetic.hpp"
#include "datasets/core/se3.hpp"

namespace loopbench {

/// `automatic` detects the format from the content, not from the file extension. A header row is
/// skipped; csv is a table whose header names time, position and quaternion, in any order. bag is a
/// ROS bag (datasets/bags). json, npy, log (a matrix over four lines) and frames (a folder with one
/// file per frame) are matrices.
enum class Format { automatic, tum, kitti, euroc, g2o, csv, bag, json, npy, log, frames };
inline auto choices(Format) {
  return std::array{std::pair{"auto", Format::automatic},
                    std::pair{"tum", Format::tum},
                    std::pair{"kitti", Format::kitti},
                    std::pair{"euroc", Format::euroc},
                    std::pair{"g2o", Format::g2o},
                    std::pair{"csv", Format::csv},
                    std::pair{"bag", Format::bag},
                    std::pair{"json", Format::json},
                    std::pair{"npy", Format::npy},
                    std::pair{"log", Format::log},
                    std::pair{"frames", Format::frames}};
}

/// Handling of a pose with the same stamp as the previous one, which occurs in published files. The
/// reader of TUM keeps the last, evo all. Decreasing stamps, and repeated stamps in a times file,
/// are always rejected. `refuse` accepts a pose that agrees with the previous one
/// (agrees_with_last()), and keeps the first of the two. `keep_all` is not a choice of users,
/// because only the association of evo accepts equal stamps.
enum class Repeats { refuse, keep_first, keep_last, keep_all };
inline auto choices(Repeats) {
  return std::array{std::pair{"refuse", Repeats::refuse},
                    std::pair{"keep_first", Repeats::keep_first},
                    std::pair{"keep_last", Repeats::keep_last}};
}

/// Unit of stamps; `automatic` decides by their size and their intervals (stamp_unit.hpp).
enum class StampUnit { automatic, s, ms, us, ns };
inline auto choices(StampUnit) {
  return std::array{std::pair{"auto", StampUnit::automatic},
                    std::pair{"s", StampUnit::s},
                    std::pair{"ms", StampUnit::ms},
                    std::pair{"us", StampUnit::us},
                    std::pair{"ns", StampUnit::ns}};
}

/// What the stamps of a file are: its own, multiples of the period for the ids of vertices and
/// frames, or multiples of the period for the numbers of rows.
enum class Clock { stamps, ids, rows };

/// Scales of matrices [scale R | t], which were removed from their rotations.
struct MatrixScales {
  std::size_t rows = 0;
  double least = 1.0;
  double largest = 1.0;

  void add(const MatrixScales& more) {
    least = rows == 0 ? more.least : std::min(least, more.least);
    largest = rows == 0 ? more.largest : std::max(largest, more.largest);
    rows += more.rows;
  }
};

/// Remarks of the readers, and the corrections that they made.
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
  Clock clock = Clock::stamps;
  std::size_t invalid = 0;                ///< rows dropped by `drop_invalid`
  std::size_t rows = 0;                   ///< of data, also those without a pose
  std::vector<std::size_t> dropped = {};  ///< numbers of the invalid rows, from 0, ascending
  std::size_t agreeing = 0;  ///< poses dropped because an agreeing one has the same stamp
  /// Maximum deviation of matrices from orthonormal that was normalised, if above 1e-3.
  double off_orthonormal = 0.0;
  MatrixScales scales = {};
  bool opengl_axes = false;  ///< axes of the camera were converted from those of OpenGL
  std::size_t angles = 0;    ///< columns of angles in place of a quaternion: 3, or 1 for a heading
  std::size_t unsorted = 0;  ///< rows moved by `sort`
  std::vector<StampUnit> units = {StampUnit::s};  ///< all that fit; the first one was used
  bool has_clear_unit = true;                     ///< the first of `units` fits best
  std::string time_column = {};                   ///< that was chosen among several
  std::string ignored_columns = {};               ///< names of a header that were not read

  /// Adds those of the next part of the same file.
  void append(const ReadFindings& part) {
    off_unit = std::max(off_unit, part.off_unit);
    repeated += part.repeated;
    for (const std::size_t row : part.dropped) dropped.push_back(rows + row);
    rows += part.rows;
    invalid += part.invalid;
    agreeing += part.agreeing;
    off_orthonormal = std::max(off_orthonormal, part.off_orthonormal);
    if (part.scales.rows > 0) scales.add(part.scales);
    without_fix += part.without_fix;
    covariances.insert(covariances.end(), part.covariances.begin(), part.covariances.end());
  }
};

struct ReadOptions {
  Format format = Format::automatic;
  /// Times file for poses without stamps, one time per line: of rows, of numbers of frames and of
  /// vertices. Without it stamps are multiples of `period`.
  std::optional<std::filesystem::path> times;
  double period = 0.1;  ///< between poses of KITTI and consecutive ids of g2o [s]
  Repeats repeats = Repeats::refuse;
  bool sort = false;          ///< accepts rows in any order of time
  bool drop_invalid = false;  ///< drops rows with numbers that are not finite, or zero quaternions
  StampUnit stamp_unit = StampUnit::automatic;  ///< of stamps without a stated unit
  /// Accepts positions without rotations (lacks_rotations()): rows `stamp x y z`, zero quaternions,
  /// tables without a quaternion, PointStamped, NavSatFix.
  bool positions = false;
  /// Origin of local coordinates for latitude, longitude and height; default: the first position.
  std::optional<GeodeticOrigin> origin = {};
  ReadFindings* findings = nullptr;  ///< written unless null
};

}  // namespace loopbench
