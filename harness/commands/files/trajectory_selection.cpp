#include "harness/commands/files/trajectory_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "datasets/core/fields.hpp"

namespace loopbench::harness {
namespace {

constexpr double kDegree = M_PI / 180.0;

}  // namespace

std::vector<std::size_t> within(const Trajectory& poses, double start, double end) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (poses[i].stamp >= start && poses[i].stamp <= end) out.push_back(i);
  }
  return out;
}

std::vector<std::size_t> evenly_spaced(std::size_t poses, std::size_t count) {
  std::vector<std::size_t> out(std::min(poses, count));
  std::iota(out.begin(), out.end(), std::size_t{0});
  if (count >= poses || count < 2) return out;
  const double step = static_cast<double>(poses - 1) / static_cast<double>(count - 1);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<std::size_t>(std::floor(static_cast<double>(i) * step));
  }
  out.back() = poses - 1;
  return out;
}

std::vector<std::size_t> by_motion(const Trajectory& poses, double metres, double degrees) {
  const bool has_angle = degrees <= 180.0;
  if (has_angle && lacks_rotations(poses)) {
    throw InputError(
        "--motion_filter: an angle needs rotations, the file has only positions; an angle above "
        "180 deg is not used");
  }
  std::vector<std::size_t> out;
  double length = 0.0;  // since the last selected pose [m]
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& pose = poses[i].world_from_body;
    if (i > 0) {
      length += (pose.translation - poses[i - 1].world_from_body.translation).norm();
      const Rotation& last = poses[out.back()].world_from_body.rotation;
      const bool is_turned = has_angle && angle_between(last, pose.rotation) >= degrees * kDegree;
      if (length < metres && !is_turned) continue;
    }
    out.push_back(i);
    length = 0.0;
  }
  return out;
}

TrajectoryFile merged(const std::vector<TrajectoryFile>& files,
                      Repeats repeats,
                      std::vector<std::size_t>& dropped) {
  std::vector<std::pair<std::size_t, std::size_t>> order;  // file, pose
  for (std::size_t f = 0; f < files.size(); ++f) {
    for (std::size_t i = 0; i < files[f].poses.size(); ++i) order.emplace_back(f, i);
  }
  const auto stamp = [&](const auto& at) { return files[at.first].poses[at.second].stamp; };
  std::ranges::stable_sort(order, {}, stamp);
  std::vector<std::pair<std::size_t, std::size_t>> kept;
  dropped.assign(files.size(), 0);
  for (const auto& at : order) {
    if (kept.empty() || stamp(kept.back()) != stamp(at)) {
      kept.push_back(at);
      continue;
    }
    if (repeats == Repeats::refuse) {
      throw InputError(
          fmt::format("stamp {} is in two files, expected --repeats keep_first or "
                      "keep_last",
                      to_text(stamp(at))));
    }
    const bool keeps_last = repeats == Repeats::keep_last;
    ++dropped[keeps_last ? kept.back().first : at.first];
    if (keeps_last) kept.back() = at;
  }
  const auto all_have = [&](auto member) {
    return std::ranges::all_of(files, [&](const TrajectoryFile& file) {
      return (file.*member).size() == file.poses.size();
    });
  };
  const bool exact = all_have(&TrajectoryFile::nanoseconds);
  const bool uncertain = all_have(&TrajectoryFile::covariances);
  TrajectoryFile out;
  out.has_stamps = std::ranges::all_of(files, &TrajectoryFile::has_stamps);
  for (const auto& [f, i] : kept) {
    out.poses.push_back(files[f].poses[i]);
    if (exact) out.nanoseconds.push_back(files[f].nanoseconds[i]);
    if (uncertain) out.covariances.push_back(files[f].covariances[i]);
  }
  return out;
}

}  // namespace loopbench::harness
