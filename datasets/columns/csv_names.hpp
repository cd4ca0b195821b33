/// Meaning of one column name in the header of a table.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace loopbench {

/// Meaning of a column. The first eight are those of kPoseColumns.
enum class Role {
  time,
  x,
  y,
  z,
  qw,
  qx,
  qy,
  qz,
  latitude,
  longitude,
  height,
  fix,
  vector_x,  ///< of a rotation vector, in radians
  vector_y,
  vector_z,
  roll,
  pitch,
  yaw
};
constexpr std::array kRoleNames{"time",
                                "x",
                                "y",
                                "z",
                                "qw",
                                "qx",
                                "qy",
                                "qz",
                                "latitude",
                                "longitude",
                                "height",
                                "fix",
                                "rvec_x",
                                "rvec_y",
                                "rvec_z",
                                "roll",
                                "pitch",
                                "yaw"};

inline Role after(Role first, std::size_t offset) {
  return static_cast<Role>(static_cast<std::size_t>(first) + offset);
}

/// Of several columns with the same role, the one of the lowest rank is taken.
enum class NameRank { usual, rare, whole_seconds, nanoseconds };

struct PoseColumn {
  Role role = Role::time;
  NameRank rank = NameRank::usual;
  std::optional<int> time_exponent = {};  ///< stated unit of time, 10^exponent [s]
  double per_metre = 1.0;                 ///< unit of a position
  bool is_in_degrees = false;             ///< stated unit of an angle; otherwise radians
  std::string order = {};                 ///< stated order of Euler angles: "zyx"
  std::string wrong_unit = {};            ///< stated, but not supported
};

/// The meaning of a name; nothing for other columns.
std::optional<PoseColumn> pose_column(std::string_view name);

/// The time in a column of another name, with the unit that it ends in.
PoseColumn assumed_time(std::string_view name);

/// Whether a name is that of a number or an image for each pose: id, frame, frame_id, image_name.
bool names_frames(std::string_view name);

/// Whether a time is the stamp in the header of a message.
bool is_message_stamp(std::string_view name);

}  // namespace loopbench
