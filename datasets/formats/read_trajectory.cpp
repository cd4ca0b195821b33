#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/g2o.hpp"
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
    double stamp = seconds_of(pose.nanoseconds);
    if (last != nullptr && pose.nanoseconds > last->nanoseconds) {
      stamp = std::max(stamp, std::nextafter(out.poses.back().stamp, HUGE_VAL));
    }
    if (bag.is_geodetic) {
      const std::string rule = violated_degrees(pose.frame_from_child.translation);
      if (!rule.empty()) throw InputError(name + ": " + rule);
    }
    const bool repeats = options.repeats != Repeats::keep_all && !out.poses.empty() &&
                         stamp == out.poses.back().stamp;
    if (repeats && is_same_pose(*last, pose)) continue;
    if (repeats) {
      if (pose.nanoseconds == 0) {
        throw InputError(name + ": several messages have stamp 0: header.stamp was not recorded");
      }
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
  if (options.times && !takes_times(file, format)) {
    throw file.error(0, "has format " + to_text(format) + " with stamps, expected no times file");
  }
  TrajectoryFile out{.poses = {}, .format = format};
  if (format == Format::g2o) {
    // Poses do not depend on the information, which programs write with six digits.
    const InformationRules any{.indefinite = IndefiniteInformation::project};
    out.poses = trajectory_of(read_g2o(path, any), file.name(), options.period);
    file.repaired.clock = Clock::ids;
  } else {
    out.poses = format == Format::kitti   ? read_kitti(file, options)
                : format == Format::euroc ? read_euroc(file, options)
                : format == Format::csv   ? read_csv(file, options)
                                          : read_tum(file, options);
  }
  out.has_stamps = file.repaired.clock == Clock::stamps;
  out.covariances = std::move(file.repaired.covariances);
  file.repaired.covariances.clear();
  if (options.findings) {
    const auto origin = options.findings->origin;  // of positions in WGS 84, already written
    *options.findings = std::move(file.repaired);
    options.findings->origin = origin;
  }
  return out;
}

/// Exact stamps of the poses in `file`, in order; empty if one is not a number of nanoseconds.
std::vector<std::int64_t> exact_stamps(const std::filesystem::path& path,
                                       const TrajectoryFile& file,
                                       const ReadOptions& options) {
  constexpr double kRounding = 1e-6;  // of large stamps as doubles [s]
  TextFile text(path);
  text.skip_header();
  const auto csv = file.format == Format::csv ? csv_columns(text) : std::nullopt;
  const int exponent = csv ? csv_exponent(text, *csv, options) : stamp_exponent(text, 0, options);
  const auto stamp_of = [&](const Line& line) {
    Columns columns(text, line);
    return csv ? csv_stamp(text, line, *csv, exponent) : next_stamp(columns, exponent);
  };
  std::vector<std::int64_t> out;
  for (Line line; text.next(line) && out.size() < file.poses.size();) {
    ReadStamp stamp;
    try {
      stamp = stamp_of(line);
    } catch (const InvalidRow&) {
      continue;  // dropped
    }
    if (!stamp.exact) return {};
    // A repeated stamp belongs to the pose that was kept.
    const bool is_repeated = !out.empty() && out.back() == *stamp.exact &&
                             options.repeats != Repeats::keep_all && !options.sort;
    const bool is_next = std::abs(stamp.seconds - file.poses[out.size()].stamp) < kRounding;
    if (is_next && !is_repeated) out.push_back(*stamp.exact);
  }
  if (out.size() != file.poses.size()) out.clear();
  return out;
}

/// Sorts by stamp and applies `repeats`. Throws InputError. O(n log n).
void sort_rows(TrajectoryFile& file, const std::string& name, const ReadOptions& options) {
  if (!options.sort) return;
  std::vector<std::size_t> order(file.poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto stamp = [&](std::size_t i) { return file.poses[i].stamp; };
  std::ranges::stable_sort(order, {}, stamp);
  std::vector<std::size_t> kept;
  std::size_t moved = 0, repeated = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && order[k] < order[k - 1]) ++moved;
    const bool repeats = !kept.empty() && stamp(order[k]) == stamp(kept.back()) &&
                         options.repeats != Repeats::keep_all;
    if (repeats && options.repeats == Repeats::refuse) {
      throw InputError(name + ": stamp " + to_text(stamp(order[k])) +
                       " is in two rows, expected different stamps (or repeats: keep_first, "
                       "keep_last)");
    }
    repeated += repeats ? 1 : 0;
    if (repeats && options.repeats == Repeats::keep_last) kept.back() = order[k];
    if (!repeats) kept.push_back(order[k]);
  }
  if (moved > 0 || repeated > 0) file = selected(file, kept);
  if (options.findings == nullptr) return;
  options.findings->unsorted = moved;
  options.findings->repeated += repeated;
}

void check_period(const ReadOptions& options) {
  if (GreaterThan{0.0}.holds(options.period)) return;
  throw OptionError("period", "period = " + to_text(options.period) + ": expected period > 0");
}

}  // namespace

std::vector<std::string> reading_notes(const ReadFindings& findings) {
  std::vector<std::string> out;
  const auto note = [&](bool is_found, const std::string& text) {
    if (is_found) out.push_back(text);
  };
  const StampUnit unit = findings.units.front();
  note(findings.invalid > 0, fmt::format("invalid rows dropped: {}", findings.invalid));
  note(findings.unsorted > 0,
       fmt::format("rows sorted, places out of order: {}", findings.unsorted));
  note(unit == StampUnit::ms || unit == StampUnit::us, "stamps are read in " + to_text(unit));
  note(!findings.time_column.empty(), "time is " + findings.time_column);
  note(!findings.ignored_columns.empty(), "columns that are not read: " + findings.ignored_columns);
  return out;
}

Trajectory read_trajectory(const std::filesystem::path& path, const ReadOptions& options) {
  check_period(options);
  const bool is_recorded = is_bag(path, options.format);
  TrajectoryFile out = is_recorded ? from_bag(path.string(), options) : from_text(path, options);
  sort_rows(out, path.string(), options);
  if (options.findings) options.findings->covariances = std::move(out.covariances);
  return std::move(out.poses);
}

TrajectoryFile read_trajectory_file(const std::filesystem::path& path, const ReadOptions& options) {
  check_period(options);
  if (is_bag(path, options.format)) return from_bag(path.string(), options);
  TrajectoryFile out = from_text(path, options);
  if (out.has_stamps && !options.times) out.nanoseconds = exact_stamps(path, out, options);
  sort_rows(out, path.string(), options);
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
