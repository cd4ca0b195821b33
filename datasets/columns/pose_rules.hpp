/// Checks common to all trajectory formats: unit quaternions and increasing stamps.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "datasets/columns/reading.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Error for a quaternion that is zero or whose norm differs from 1 by more than 1e-2.
InputError wrong_norm(const TextFile& file, std::size_t line, double norm);

/// Throws InputError for latitudes and longitudes [deg] out of range.
inline void require_degrees(const TextFile& file, std::size_t line, const Vector3& position) {
  const std::string rule = violated_degrees(position);
  if (!rule.empty()) throw file.error(line, rule);
}

/// Converts what was read to local coordinates, with the origin of the options if they state one,
/// and stores the origin.
Trajectory local_positions(Trajectory geodetic, const ReadOptions& options, ReadFindings& findings);

/// Throws InvalidRow for a row with a zero quaternion below rows with rotations, and InputError for
/// the reverse, unless `options` drop the invalid rows `above`.
void reject_mixed_rows(const TextFile& file,
                       const Line& line,
                       bool is_zero,
                       const ReadOptions& options,
                       Trajectory& above);

/// The error of an invalid row, with the option that drops such rows.
InputError with_remedy(const InvalidRow& error);

/// Normalises a quaternion. Throws InputError if it is not unit, see normalise().
inline Rotation normalized_rotation(const TextFile& file, std::size_t line, Rotation given) {
  if (normalise(given, file.repaired.off_unit)) return given;
  throw wrong_norm(file, line, given.norm());
}

/// The rotation of a row below `above`. Files of positions can have a zero quaternion in every row:
/// then it is no_rotation(), if the options accept positions. Throws InputError for rows of both
/// kinds, and like normalized_rotation().
inline Rotation rotation_of_row(const TextFile& file,
                                const Line& line,
                                const Rotation& given,
                                Trajectory& above,
                                const ReadOptions& options) {
  const bool is_zero = options.positions && given.coeffs().isZero(0.0);
  if (!above.empty() && is_zero != lacks_rotations(above)) {
    reject_mixed_rows(file, line, is_zero, options, above);
  }
  return is_zero ? no_rotation() : normalized_rotation(file, line.number, given);
}

/// Whether the rows of `b` can be below those of `a`.
inline bool follows(const Trajectory& a, const Trajectory& b, bool in_any_order) {
  if (a.empty() || b.empty()) return false;
  const bool are_ordered = in_any_order || a.back().stamp < b.front().stamp;
  return are_ordered && lacks_rotations(a) == lacks_rotations(b);
}

/// Calls read(line) for every line of data; drops those that throw InvalidRow, if `options` say so.
template <class Read>
void for_each_row(TextFile& file, const ReadOptions& options, Read read) {
  ReadFindings& found = file.repaired;
  for (Line line; file.next(line); ++found.rows) {
    try {
      read(line);
    } catch (const InvalidRow& error) {
      if (!options.drop_invalid) throw with_remedy(error);
      ++found.invalid;
      found.dropped.push_back(found.rows);
    }
  }
}

/// Whether a pose with the stamp of the last one differs from it by no more than twice the largest
/// motion between the last eight poses, in position and in rotation.
bool agrees_with_last(const Trajectory& poses, const Pose& again);

/// Enforces strictly increasing stamps. Errors state both lines.
class StampOrder {
 public:
  /// `exponent`: unit of the stamps. `column`: of the stamps, for the error of repeated ones.
  StampOrder(const TextFile& file, const ReadOptions& options, int exponent, std::size_t column = 0)
      : file_(file), options_(options), exponent_(exponent), column_(column) {}

  /// Appends a pose to `poses`. A pose with a repeated stamp replaces the last one or is dropped,
  /// depending on `repeats`. Different stamps (`word`) that are one double become consecutive
  /// doubles. Throws InputError.
  void put(
      double stamp, std::string_view word, std::size_t line, const Pose& pose, Trajectory& poses) {
    if (accepts(stamp, word, line, &poses, &pose) || poses.empty()) {
      poses.push_back({last_stamp_, pose});
    } else if (options_.repeats == Repeats::keep_last) {
      poses.back().world_from_body = pose;
    }
  }

  /// Returns false if `stamp` repeats the last one, which is not kept. A repeated stamp needs a
  /// pose that agrees with the last one of `poses`. Throws InputError.
  bool accepts(double stamp,
               std::string_view word,
               std::size_t line,
               const Trajectory* poses = nullptr,
               const Pose* pose = nullptr) {
    const bool is_ordered = last_line_ == 0 || options_.sort || stamp > last_stamp_;
    if (!is_ordered && !is_later(stamp, word)) {
      const bool is_kept = options_.repeats == Repeats::keep_all && stamp == last_stamp_;
      if (!is_kept) {
        reject_or_drop(stamp, line, poses, pose);
        return false;
      }
    }
    last_stamp_ = stamp;
    last_word_ = word;
    last_line_ = line;
    return true;
  }

 private:
  void reject_or_drop(double stamp, std::size_t line, const Trajectory* poses, const Pose* pose);
  bool is_later(double& stamp, std::string_view word) const;

  const TextFile& file_;
  const ReadOptions& options_;
  int exponent_;
  std::size_t column_;
  double last_stamp_ = 0.0;
  std::string last_word_;
  std::size_t last_line_ = 0;
  bool has_enough_stamps_ = false;  // checked once
};

}  // namespace loopbench
