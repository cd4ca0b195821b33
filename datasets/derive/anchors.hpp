/// Anchors from a file of measured positions.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/bags/messages.hpp"
#include "datasets/columns/columns.hpp"
#include "datasets/core/params.hpp"
#include "datasets/core/sequence.hpp"
#include "datasets/derive/poses_at.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench {

/// A measured position in the world frame of its file.
struct StampedPosition {
  double stamp = 0.0;  ///< [s]
  Vector3 position = Vector3::Zero();
  Matrix3 covariance = Matrix3::Identity();
};

struct AnchorFile {
  std::vector<StampedPosition> positions;  ///< ascending stamps
  std::string note;  ///< origin of the local frame of latitude, longitude and height; may be empty
};

inline constexpr std::size_t kWithSigma = 5;
inline constexpr std::size_t kWithCovariance = 10;

inline StampedPosition parse_position(const TextFile& file, const Line& line, std::size_t count) {
  if (count_columns(file, line) != count) {
    throw file.error(line.number,
                     "has " + columns_text(count_columns(file, line)) + ", expected " +
                         std::to_string(count) + " as in the first row: stamp x y z and " +
                         (count == kWithSigma ? "sigma" : "covariance"));
  }
  Columns columns(file, line);
  StampedPosition out;
  out.stamp = columns.number("stamp");
  for (double& x : out.position) x = columns.number("position");
  if (count == kWithSigma) {
    const double sigma = columns.number("sigma");
    if (!(sigma > 0.0)) {
      throw file.error(line.number, "found sigma " + to_text(sigma) + ", expected a value > 0");
    }
    out.covariance *= sigma * sigma;
    return out;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      out.covariance(i, j) = out.covariance(j, i) = columns.number("covariance");
    }
  }
  if (out.covariance.llt().info() != Eigen::Success) {
    throw file.error(line.number, "covariance is not positive definite");
  }
  return out;
}

inline std::vector<StampedPosition> read_rows(TextFile& file, std::size_t count) {
  std::vector<StampedPosition> out;
  for (Line line; file.next(line);) {
    out.push_back(parse_position(file, line, count));
    if (out.size() > 1 && !(out.back().stamp > out[out.size() - 2].stamp)) {
      throw file.error(line.number,
                       "stamp " + to_text(out.back().stamp) + " is not after the previous one, " +
                           to_text(out[out.size() - 2].stamp));
    }
  }
  return out;
}

/// Reads rows `stamp x y z`, `stamp x y z sigma`, or `stamp x y z` and the upper triangle of the
/// covariance (xx xy xz yy yz zz), in [s], [m], [m^2], or any format of read_trajectory() with
/// positions. Rows without sigma or covariance have standard deviation `sigma`. Throws InputError.
/// O(size of the file).
inline AnchorFile read_anchor_file(const std::filesystem::path& file, double sigma) {
  if (!names_bag(file.string()) && bag_kind(open_input(file)) == BagKind::none) {
    TextFile text(file);
    text.skip_header();
    Line line;
    if (text.header().empty() && text.next(line)) {
      const std::size_t count = count_columns(text, line);
      text.put_back(line);
      if (count == kWithSigma || count == kWithCovariance) return {read_rows(text, count), ""};
    }
  }
  ReadFindings findings;
  ReadOptions options;
  options.positions = true;
  options.findings = &findings;
  const Trajectory poses = read_trajectory(file, options);
  AnchorFile out;
  if (findings.origin) out.note = file.string() + ": " + to_text(*findings.origin);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    out.positions.push_back({poses[i].stamp,
                             poses[i].world_from_body.translation,
                             sigma * sigma * Matrix3::Identity()});
    if (findings.covariances.empty()) continue;
    out.positions.back().covariance = findings.covariances[i].topLeftCorner<3, 3>();
  }
  return out;
}

/// Converts positions to anchors at the nearest keyframe in time. Between keyframes, the anchor's
/// point in the frame of the keyframe is the position of the body that `run`, all tracked poses
/// including keyframes, has at the stamp. Positions before the first and after the last pose, and
/// in gaps beyond `reach`, are skipped and counted in `skipped`. O((poses + positions) log
/// keyframes).
inline std::vector<Anchor> as_anchors(const std::vector<StampedPosition>& positions,
                                      const Trajectory& keyframes,
                                      const Trajectory& run,
                                      const InterpolationLimits& reach,
                                      std::size_t& skipped) {
  std::vector<double> times;
  for (const StampedPosition& each : positions) times.push_back(each.stamp);
  const auto poses = poses_at(run, times, reach);
  std::vector<Anchor> out;
  skipped = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto nearest = nearest_pose(keyframes, times[i], std::numeric_limits<double>::infinity());
    if (!poses[i] || !nearest) {
      ++skipped;
      continue;
    }
    const Pose& at = keyframes[*nearest].world_from_body;
    const Vector3 point = at.inverse() * poses[i]->translation;
    out.push_back({*nearest, positions[i].position, positions[i].covariance, point});
  }
  std::ranges::stable_sort(out, {}, &Anchor::keyframe);
  return out;
}

/// Sets the anchors of the sequence's problem from those positions of the file that are between two
/// poses of `run` at most `max_gap` apart [s], and adds notes on the file and on those skipped.
/// Throws InputError with `name` if all are skipped.
inline void add_anchors(const AnchorFile& file,
                        const std::string& name,
                        const Trajectory& run,
                        double max_gap,
                        Sequence& sequence) {
  std::size_t skipped = 0;
  Problem& problem = sequence.problem;
  problem.anchors = as_anchors(
      file.positions, problem.keyframes, run, {max_gap, InterpolationLimits{}.max_diff}, skipped);
  if (problem.anchors.empty()) {
    throw InputError(name + ": no position is at the time of a pose");
  }
  std::vector<std::string>& notes = sequence.provenance.notes;
  if (!file.note.empty()) notes.push_back(file.note);
  if (skipped == 0) return;
  notes.push_back(
      fmt::format("{}: {} of {} positions skipped, which are not between two poses at most {} s "
                  "apart",
                  name,
                  skipped,
                  file.positions.size(),
                  max_gap));
}

}  // namespace loopbench
