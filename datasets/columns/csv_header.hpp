/// Meaning of the columns that a header names, with their units.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace loopbench {

/// Columns of a pose, in this order.
inline constexpr std::array kPoseColumns{"time", "x", "y", "z", "qw", "qx", "qy", "qz"};

/// Indices of the columns kPoseColumns in a row with `width` columns. The rotation can be missing.
struct CsvColumns {
  std::array<std::size_t, kPoseColumns.size()> index{};
  std::size_t width = 0;
  std::optional<int> time_exponent;                ///< stated unit of time, 10^exponent [s]
  std::optional<std::size_t> nanoseconds;          ///< column to add to whole seconds
  std::array<double, 3> per_metre{1.0, 1.0, 1.0};  ///< unit of x, y and z
  bool has_rotation = true;
  bool is_geodetic = false;                  ///< x, y, z: latitude, longitude [deg], height
  std::optional<std::size_t> fix;            ///< status of a NavSatFix; negative: no position
  std::vector<std::size_t> covariance = {};  ///< upper triangle by rows: 21, without rotation 6
  std::vector<std::string> names = {};       ///< of all columns
  bool names_frames = false;                 ///< the time is in a column such as frame_id or image
  std::string time_column = {};              ///< name of the time, if others name times, too
  std::string ignored = {};                  ///< names of columns that are not read
  /// Instead of a quaternion: roll, pitch and yaw with R = Rz(yaw) Ry(pitch) Rx(roll), or the
  /// heading of a planar pose, which has no z. Empty: quaternion.
  std::vector<std::size_t> angles = {};
  double per_radian = 1.0;  ///< unit of the angles
  std::string order = {};   ///< of roll, pitch, yaw: "xyz" for Rx Ry Rz; empty: as above
  bool is_vector = false;   ///< the angles are a rotation vector
  bool lacks_z = false;     ///< z is 0
  bool has_more = false;    ///< rows can have further columns: the header ends in a name as *covar
};

struct CsvHeader {
  std::optional<CsvColumns> columns;
  std::string why_not;  ///< "has a header that ..."; empty if there are columns with a rotation
  std::size_t width = 0;
  bool names_time = false;
  bool names_position = false;    ///< any of x, y, z
  bool names_quaternion = false;  ///< any of qw, qx, qy, qz
};

/// Recognises names such as t, time, timestamp [ns], secs and nsecs; x, tx, p_x [mm],
/// pose.position.x; qw, q_w, orientation.w, and q0 to q3 in the order w, x, y, z. The usual name is
/// taken if a rare one (epoch, rx) is present, too. Without any column of a quaternion, the rows
/// are positions; instead of x, y and z they can have latitude (lat), longitude (lon) and height
/// (alt). cov_x_x, cov_x_y, ... cov_yaw_yaw are the upper triangle of a covariance, which has to be
/// complete. Without a quaternion, roll, pitch and yaw are the rotation (in radians unless the unit
/// is deg; another order follows it, [deg, xyz] for Rx Ry Rz), rvec_x, rvec_y and rvec_z are a
/// rotation vector, and x, y and theta (yaw, heading) are a planar pose. If only the time is
/// missing, it is in a column such as frame_id, id or image, or else in the first column, if no
/// other one is unknown. The stamp of a message (header.stamp) is taken rather than the time of its
/// receipt. Columns with an empty name are ignored.
CsvHeader csv_header(std::string_view header);

/// Splits a row or a header at commas, or at blanks if it has none. Quotes around a column are
/// removed; an empty last column is dropped. The views point into `text`.
void split_columns(std::string_view text, std::vector<std::string_view>& out);

}  // namespace loopbench
