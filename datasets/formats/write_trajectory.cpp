#include <fmt/format.h>

#include <cmath>

#include "datasets/columns/covariance_columns.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/files/text_writer.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {
namespace {

/// Throws InputError for stamps that do not fit, or that are no longer different.
std::vector<std::int64_t> rounded_nanoseconds(const TrajectoryFile& file,
                                              const std::filesystem::path& path) {
  constexpr double kMost = 9.2e9;  // [s]; int64_t holds 9.22e9
  if (!file.nanoseconds.empty()) return file.nanoseconds;
  std::vector<std::int64_t> out;
  out.reserve(file.poses.size());
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    const double stamp = file.poses[i].stamp;
    const double seconds = std::floor(stamp);
    if (!(std::abs(stamp) < kMost)) {
      throw InputError(fmt::format(
          "{}: nanoseconds of stamp {} do not fit in 64 bits, expected seconds below {}",
          path.string(),
          stamp,
          kMost));
    }
    const auto whole = static_cast<std::int64_t>(seconds) * 1'000'000'000;
    out.push_back(whole + std::llround((stamp - seconds) * 1e9));
    if (i > 0 && out[i] == out[i - 1] && stamp != file.poses[i - 1].stamp) {
      throw InputError(fmt::format("{}: stamps {} and {} are one nanosecond",
                                   path.string(),
                                   file.poses[i - 1].stamp,
                                   stamp));
    }
  }
  return out;
}

void write_stamp(TextWriter& out, const TrajectoryFile& file, std::size_t i) {
  if (file.nanoseconds.empty()) {
    out.word(fmt::format("{}", file.poses[i].stamp));  // shortest, but 1700000000, not 1.7e+09
  } else {
    out.word(seconds_text(file.nanoseconds[i]));
  }
}

void write_position(TextWriter& out, const Pose& pose) {
  for (const double value : pose.translation) out.number(value);
}

/// Stamp, x, y, z, and with a rotation qx, qy, qz, qw.
void write_row(TextWriter& out, const TrajectoryFile& file, std::size_t i) {
  const Pose& pose = file.poses[i].world_from_body;
  write_stamp(out, file, i);
  write_position(out, pose);
  if (!has_rotation(pose)) return;
  for (const double value : pose.rotation.coeffs()) out.number(value);
}

TextWriter tum_text(const TrajectoryFile& file, const std::vector<std::string>& comments) {
  TextWriter out;
  for (const std::string& comment : comments) out.comment(comment);
  const bool is_uncertain = has_covariances(file, Format::tum);
  if (is_uncertain) out.word("#%TANGENT_CONVENTION fixed_axes").end_line();
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    write_row(out, file, i);
    if (is_uncertain) {
      for (const double value : file.covariances[i].reshaped()) out.number(value);  // symmetric
    }
    out.end_line();
  }
  return out;
}

TextWriter kitti_text(const TrajectoryFile& file) {
  TextWriter out;
  for (const auto& [stamp, pose] : file.poses) {
    const Matrix3 R = pose.rotation.toRotationMatrix();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out.number(R(i, j));
      out.number(pose.translation[i]);
    }
    out.end_line();
  }
  return out;
}

TextWriter times_text(const TrajectoryFile& file) {
  TextWriter out;
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    write_stamp(out, file, i);
    out.end_line();
  }
  return out;
}

TextWriter euroc_text(const TrajectoryFile& file, const std::filesystem::path& path) {
  const std::vector<std::int64_t> stamps = rounded_nanoseconds(file, path);
  TextWriter out(',');
  out.comment("timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []");
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    const Pose& pose = file.poses[i].world_from_body;
    out.integer(stamps[i]);
    write_position(out, pose);
    const Rotation& q = pose.rotation;
    out.number(q.w()).number(q.x()).number(q.y()).number(q.z());
    out.end_line();
  }
  return out;
}

TextWriter csv_text(const TrajectoryFile& file) {
  TextWriter out(',');
  const bool has_rotations = !lacks_rotations(file.poses);
  for (const char* name : {"timestamp", "x", "y", "z"}) out.word(name);
  if (has_rotations) {
    for (const char* name : {"qx", "qy", "qz", "qw"}) out.word(name);
  }
  const Eigen::Index axes = file.covariances.empty() ? 0 : has_rotations ? 6 : 3;
  if (axes > 0) {
    for (const std::string& name : covariance_names(has_rotations)) out.word(name);
  }
  out.end_line();
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    write_row(out, file, i);
    for (Eigen::Index a = 0; a < axes; ++a) {
      for (Eigen::Index b = a; b < axes; ++b) out.number(file.covariances[i](a, b));
    }
    out.end_line();
  }
  return out;
}

PoseGraph graph_of(const Trajectory& poses) {
  PoseGraph out;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    out.ids.push_back(static_cast<std::int64_t>(i));
    out.vertices.push_back(poses[i].world_from_body);
  }
  return out;
}

}  // namespace

bool has_covariances(const TrajectoryFile& file, Format format) {
  if (file.covariances.empty()) return false;
  return format == Format::csv || (format == Format::tum && !lacks_rotations(file.poses));
}

void write_trajectory(const std::filesystem::path& file,
                      const TrajectoryFile& trajectory,
                      Format format,
                      const std::optional<std::filesystem::path>& times) {
  check(trajectory.poses, file.string(), Rotations::optional);
  if (lacks_rotations(trajectory.poses) && format != Format::tum && format != Format::csv) {
    throw InputError(file.string() + ": " + to_text(format) +
                     " needs rotations, expected tum or csv for positions without rotation");
  }
  switch (format) {
    case Format::tum:
      tum_text(trajectory, {}).save(file);
      break;
    case Format::kitti:
      kitti_text(trajectory).save(file);
      break;
    case Format::euroc:
      euroc_text(trajectory, file).save(file);
      break;
    case Format::csv:
      csv_text(trajectory).save(file);
      break;
    case Format::g2o:
      write_g2o(file, graph_of(trajectory.poses));
      break;
    case Format::bag:
    case Format::automatic:
      throw InputError("format: found " + to_text(format) +
                       ", expected tum, kitti, euroc, g2o or csv");
  }
  if (times) times_text(trajectory).save(*times);
}

void write_tum(const std::filesystem::path& file,
               const TrajectoryFile& trajectory,
               const std::vector<std::string>& comments) {
  check(trajectory.poses, file.string());
  tum_text(trajectory, comments).save(file);
}

void write_tum(const std::filesystem::path& file,
               const Trajectory& trajectory,
               const std::vector<std::string>& comments) {
  write_tum(file, TrajectoryFile{trajectory}, comments);
}

}  // namespace loopbench
