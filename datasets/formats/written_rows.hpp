/// Parts of rows that several formats write.
#pragma once

#include <fmt/format.h>

#include <cstddef>

#include "datasets/columns/stamps.hpp"
#include "datasets/files/text_writer.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {

/// Exact stamps with all digits, others in the shortest form.
inline void write_stamp(TextWriter& out, const TrajectoryFile& file, std::size_t i) {
  if (file.nanoseconds.empty()) {
    out.word(fmt::format("{}", file.poses[i].stamp));  // shortest, but 1700000000, not 1.7e+09
  } else {
    out.word(seconds_text(file.nanoseconds[i]));
  }
}

inline void write_position(TextWriter& out, const Pose& pose) {
  for (const double value : pose.translation) out.number(value);
}

/// Stamp, x, y, z, and with a rotation qx, qy, qz, qw.
inline void write_row(TextWriter& out, const TrajectoryFile& file, std::size_t i) {
  const Pose& pose = file.poses[i].world_from_body;
  write_stamp(out, file, i);
  write_position(out, pose);
  if (!has_rotation(pose)) return;
  for (const double value : pose.rotation.coeffs()) out.number(value);
}

}  // namespace loopbench
