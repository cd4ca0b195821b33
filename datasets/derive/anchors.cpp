#include "datasets/derive/anchors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/bags/messages.hpp"
#include "datasets/core/params.hpp"
#include "datasets/formats/columns.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kWithSigma = 5;
constexpr std::size_t kWithCovariance = 10;

StampedPosition parse_position(const TextFile& file, const Line& line, std::size_t count) {
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

std::vector<StampedPosition> read_rows(TextFile& file, std::size_t count) {
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

}  // namespace

AnchorFile read_anchor_file(const std::filesystem::path& file, double sigma) {
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

std::vector<Anchor> as_anchors(const std::vector<StampedPosition>& positions,
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

void add_anchors(const AnchorFile& file,
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
