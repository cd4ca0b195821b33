#include <optional>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/columns.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/pose_rules.hpp"
#include "datasets/formats/stamps.hpp"
#include "datasets/formats/text_formats.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {
namespace {

Trajectory trajectory_of(const PoseGraph& graph, const std::string& name, double period) {
  std::vector<Pose> composed;
  if (graph.vertices.empty()) composed = chain(graph, name);
  const std::vector<Pose>& poses = graph.vertices.empty() ? composed : graph.vertices;
  Trajectory out;
  out.reserve(poses.size());
  const std::vector<double> stamps = vertex_stamps(graph, period);
  for (std::size_t i = 0; i < poses.size(); ++i) out.push_back({stamps[i], poses[i]});
  check(out, name);  // composed poses may overflow; ids above 2^53 may give equal stamps
  return out;
}

bool is_same_pose(const PoseMessage& a, const PoseMessage& b) {
  return a.nanoseconds == b.nanoseconds &&
         a.frame_from_child.translation == b.frame_from_child.translation &&
         a.frame_from_child.rotation.coeffs() == b.frame_from_child.rotation.coeffs();
}

TrajectoryFile from_bag(const std::string& name, const ReadOptions& options) {
  BagTrajectory bag = read_bag_trajectory(bag_name(name));
  if (!options.positions && !has_rotation(bag.poses.front().frame_from_child)) {
    throw InputError(name + ": topic '" + bag.topic +
                     "' has positions without rotation, which are accepted only as a reference, "
                     "and by eval, doctor and traj");
  }
  TrajectoryFile out{.poses = {}, .format = Format::bag};
  ReadFindings findings{bag.off_unit, 0, bag.damage};
  bool has_covariances = true;
  const PoseMessage* last = nullptr;
  for (const PoseMessage& pose : bag.poses) {
    const double stamp = seconds_of(pose.nanoseconds);
    if (bag.is_geodetic) {
      const std::string rule = violated_degrees(pose.frame_from_child.translation);
      if (!rule.empty()) throw InputError(name + ": " + rule);
    }
    const bool repeats = options.repeats != Repeats::keep_all && !out.poses.empty() &&
                         stamp == out.poses.back().stamp;
    if (repeats && is_same_pose(*last, pose)) continue;
    if (repeats) {
      if (options.repeats == Repeats::refuse) {
        throw InputError(name + ": stamp " + seconds_text(pose.nanoseconds) +
                         " has two poses, expected increasing stamps (or repeats: keep_first, "
                         "keep_last)");
      }
      ++findings.repeated;
      if (options.repeats == Repeats::keep_first) continue;
      out.poses.pop_back();
      out.nanoseconds.pop_back();
      if (has_covariances) out.covariances.pop_back();
    }
    last = &pose;
    out.poses.push_back({stamp, pose.frame_from_child});
    out.nanoseconds.push_back(pose.nanoseconds);
    has_covariances &= pose.covariance.has_value() && pose.covariance->allFinite();
    if (has_covariances) out.covariances.push_back(*pose.covariance);
  }
  if (!has_covariances) out.covariances.clear();
  if (options.findings) *options.findings = findings;
  if (bag.is_geodetic) out.poses = local_positions(std::move(out.poses), options);
  return out;
}

bool is_bag(const std::filesystem::path& path, Format format) {
  if (names_bag(path.string()) || format == Format::bag) return true;
  return format == Format::automatic && bag_kind(open_input(path)) != BagKind::none;
}

/// Rejects options that do not fit, then reads a text file.
TrajectoryFile from_text(const std::filesystem::path& path, const ReadOptions& options) {
  TextFile file(path);
  file.skip_header();
  const Format format = options.format == Format::automatic ? detect_format(file) : options.format;
  if (options.times && format != Format::kitti) {
    throw file.error(
        0, "has format " + to_text(format) + ", which contains stamps, expected no times file");
  }
  TrajectoryFile out{.poses = {}, .format = format};
  if (format == Format::kitti) {
    out.poses = read_kitti(file, options);
    out.has_stamps = options.times.has_value();
    return out;
  }
  if (format == Format::g2o) {
    // Poses do not depend on the information, which programs write with six digits.
    const InformationRules any{.indefinite = IndefiniteInformation::project};
    out.poses = trajectory_of(read_g2o(path, any), file.name(), options.period);
    out.has_stamps = false;
    return out;
  }
  out.poses = format == Format::euroc ? read_euroc(file, options)
              : format == Format::csv ? read_csv(file, options)
                                      : read_tum(file, options);
  out.covariances = std::move(file.repaired.covariances);
  if (options.findings) {
    options.findings->off_unit = file.repaired.off_unit;
    options.findings->repeated = file.repaired.repeated;
    options.findings->without_fix = file.repaired.without_fix;
    options.findings->assumed_axes = file.repaired.assumed_axes;
  }
  return out;
}

/// The stamp in the first column of a tum or euroc file.
ReadStamp first_stamp(const TextFile& text, const Line& line, Format format, bool small) {
  Columns columns(text, line);
  if (format != Format::euroc) return next_stamp(columns, small);
  const std::string_view word = columns.peek();
  return read_stamp(word, columns.number("stamp"), -9);
}

/// Exact stamps of the poses in `file`, in order; empty if one is not a number of nanoseconds.
std::vector<std::int64_t> exact_stamps(const std::filesystem::path& path,
                                       const TrajectoryFile& file) {
  TextFile text(path);
  text.skip_header();
  const auto csv = file.format == Format::csv ? csv_columns(text) : std::nullopt;
  const bool small = file.format == Format::tum && has_small_nanoseconds(text);
  std::vector<std::int64_t> out;
  for (Line line; text.next(line) && out.size() < file.poses.size();) {
    const ReadStamp stamp =
        csv ? csv_stamp(text, line, *csv) : first_stamp(text, line, file.format, small);
    if (!stamp.exact) return {};
    // A repeated stamp belongs to the pose that was kept.
    if (stamp.seconds == file.poses[out.size()].stamp) out.push_back(*stamp.exact);
  }
  if (out.size() != file.poses.size()) out.clear();
  return out;
}

void check_period(const ReadOptions& options) {
  if (GreaterThan{0.0}.holds(options.period)) return;
  throw OptionError("period", "period = " + to_text(options.period) + ": expected period > 0");
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path, const ReadOptions& options) {
  check_period(options);
  const bool is_recorded = is_bag(path, options.format);
  TrajectoryFile out = is_recorded ? from_bag(path.string(), options) : from_text(path, options);
  if (options.findings) options.findings->covariances = std::move(out.covariances);
  return std::move(out.poses);
}

TrajectoryFile read_trajectory_file(const std::filesystem::path& path, const ReadOptions& options) {
  check_period(options);
  if (is_bag(path, options.format)) return from_bag(path.string(), options);
  TrajectoryFile out = from_text(path, options);
  const bool has_text_stamps = out.format != Format::kitti && out.format != Format::g2o;
  if (has_text_stamps) out.nanoseconds = exact_stamps(path, out);
  return out;
}

TrajectoryFile selected(const TrajectoryFile& file, const std::vector<std::size_t>& indices) {
  TrajectoryFile out{.poses = {}, .format = file.format, .has_stamps = file.has_stamps};
  for (const std::size_t i : indices) {
    out.poses.push_back(file.poses[i]);
    if (!file.nanoseconds.empty()) out.nanoseconds.push_back(file.nanoseconds[i]);
    if (!file.covariances.empty()) out.covariances.push_back(file.covariances[i]);
  }
  return out;
}

}  // namespace loopbench
