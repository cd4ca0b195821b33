/// Checks common to all trajectory formats: unit quaternions and increasing stamps.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Error for a quaternion that is zero or whose norm differs from 1 by more than 1e-2.
InputError wrong_norm(const TextFile& file, std::size_t line, double norm);

/// Throws InputError for latitudes and longitudes [deg] out of range.
inline void require_degrees(const TextFile& file, std::size_t line, const Vector3& position) {
  const std::string rule = violated_degrees(position);
  if (!rule.empty()) throw file.error(line, rule);
}

/// Converts what was read to local coordinates, with the origin of the options if they state one.
Trajectory local_positions(Trajectory geodetic, const ReadOptions& options);

/// Error for a row with a zero quaternion below rows with rotations, or the reverse.
InputError mixed_rows(const TextFile& file, const Line& line, bool is_zero);

/// Normalises a quaternion. Throws InputError if it is not unit, see normalise().
inline Rotation normalized_rotation(const TextFile& file, std::size_t line, Rotation given) {
  if (normalise(given, file.repaired.off_unit)) return given;
  throw wrong_norm(file, line, given.norm());
}

/// The rotation of a row below `above`. Files of positions can have a zero quaternion in every row:
/// then it is no_rotation(), if `positions` accepts them. Throws InputError for rows of both kinds,
/// and like normalized_rotation().
inline Rotation rotation_of_row(const TextFile& file,
                                const Line& line,
                                const Rotation& given,
                                const Trajectory& above,
                                bool positions) {
  const bool is_zero = positions && given.coeffs().isZero(0.0);
  if (!above.empty() && is_zero != lacks_rotations(above)) throw mixed_rows(file, line, is_zero);
  return is_zero ? no_rotation() : normalized_rotation(file, line.number, given);
}

/// Whether the rows of `b` can be below those of `a`.
inline bool follows(const Trajectory& a, const Trajectory& b) {
  return a.back().stamp < b.front().stamp && lacks_rotations(a) == lacks_rotations(b);
}

/// Enforces strictly increasing stamps. Errors state both lines.
class StampOrder {
 public:
  /// `hint` is appended to the error for a repeated stamp.
  StampOrder(const TextFile& file,
             Repeats repeats,
             const char* hint = " (or repeats: keep_first, keep_last)")
      : file_(file), repeats_(repeats), hint_(hint) {}

  /// Appends a pose to `poses`. A pose with a repeated stamp replaces the last one or is dropped,
  /// depending on `repeats`. Throws InputError.
  void put(double stamp, std::size_t line, const Pose& pose, Trajectory& poses) {
    if (accepts(stamp, line)) {
      poses.push_back({stamp, pose});
    } else if (repeats_ == Repeats::keep_last) {
      poses.back() = {stamp, pose};
    }
  }

  /// Returns false if `stamp` repeats the last one, which is not kept. Throws InputError.
  bool accepts(double stamp, std::size_t line) {
    const bool is_kept = repeats_ == Repeats::keep_all && stamp == last_stamp_;
    if (last_line_ != 0 && !(stamp > last_stamp_) && !is_kept) {
      reject_or_drop(stamp, line);
      return false;
    }
    last_stamp_ = stamp;
    last_line_ = line;
    return true;
  }

 private:
  void reject_or_drop(double stamp, std::size_t line) const;

  const TextFile& file_;
  Repeats repeats_;
  const char* hint_;
  double last_stamp_ = 0.0;
  std::size_t last_line_ = 0;
};

}  // namespace loopbench
