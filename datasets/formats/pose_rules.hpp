/// Rules that hold for every trajectory format: unit attitudes and increasing stamps.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// The quaternion as a unit one. Throws InputError when it is zero, or further than 1e-2 from unit
/// length: printed digits explain less, and another column order or format explains more.
Rotation unit_rotation(const TextFile& file, std::size_t line, Rotation given);

/// Keeps stamps in strictly increasing order of stamps, or says which two lines break that.
class InOrder {
 public:
  /// `hint` ends the refusal of a repeat: what the reader may do about it.
  InOrder(const TextFile& file,
          Repeats repeats,
          const char* hint = " (or repeats: keep_first, keep_last)")
      : file_(file), repeats_(repeats), hint_(hint) {}

  /// Puts a pose into `poses`: at its end, in the place of the last one whose stamp it repeats, or
  /// nowhere.
  void put(double stamp, std::size_t line, const Pose& pose, Trajectory& poses) {
    if (accepts(stamp, line)) {
      poses.push_back({stamp, pose});
    } else if (repeats_ == Repeats::keep_last) {
      poses.back() = {stamp, pose};
    }
  }

  /// False when this stamp repeats the last one and is not refused.
  bool accepts(double stamp, std::size_t line) {
    if (last_line_ != 0 && !(stamp > last_stamp_)) {
      refuse_or_drop(stamp, line);
      return false;
    }
    last_stamp_ = stamp;
    last_line_ = line;
    return true;
  }

 private:
  void refuse_or_drop(double stamp, std::size_t line) const;

  const TextFile& file_;
  Repeats repeats_;
  const char* hint_;
  double last_stamp_ = 0.0;
  std::size_t last_line_ = 0;
};

}  // namespace loopbench
