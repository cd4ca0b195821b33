#include "harness/eval/trajectory_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "datasets/core/fields.hpp"
#include "datasets/core/polyline.hpp"

namespace loopbench::harness {
namespace {

constexpr double kDegree = M_PI / 180.0;

double metres_between(const StampedPose& a, const StampedPose& b) {
  return (b.world_from_body.translation - a.world_from_body.translation).norm();
}

double radians_between(const StampedPose& a, const StampedPose& b) {
  return angle_between(a.world_from_body.rotation, b.world_from_body.rotation);
}

/// Path length or accumulated angle up to each pose; strictly increasing is not guaranteed.
template <class Length>
std::vector<double> accumulated(const Trajectory& poses, Length length) {
  std::vector<double> out(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    out[i] = out[i - 1] + length(poses[i - 1], poses[i]);
  }
  return out;
}

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

std::vector<std::size_t> by_motion(const Trajectory& poses, const MotionStep& step) {
  if (step.degrees && lacks_rotations(poses)) {
    throw InputError("a step in degrees needs rotations, the file has only positions");
  }
  constexpr double kRounding = 1e-6;  // of stamp differences [s], as for keyframes
  std::vector<std::size_t> out;
  double metres = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) metres += metres_between(poses[i - 1], poses[i]);
    const bool is_reached =
        i == 0 ||
        (step.seconds && poses[i].stamp - poses[out.back()].stamp >= *step.seconds - kRounding) ||
        (step.metres && metres >= *step.metres) ||
        (step.degrees && radians_between(poses[out.back()], poses[i]) >= *step.degrees * kDegree);
    if (!is_reached) continue;
    out.push_back(i);
    metres = 0.0;
  }
  return out;
}

Trajectory resampled(const Trajectory& poses, const MotionStep& step) {
  constexpr double kMostPoses = 1e8;
  const int given =
      int{step.seconds.has_value()} + int{step.metres.has_value()} + int{step.degrees.has_value()};
  if (given != 1) throw InputError("resample: expected one of a time, a distance and an angle");
  const double size = step.seconds  ? *step.seconds
                      : step.metres ? *step.metres
                                    : *step.degrees * kDegree;
  if (!(size > 0.0)) throw InputError("resample: expected a step above 0");
  if (poses.size() < 2) return poses;
  std::vector<double> along = stamps(poses);
  if (step.metres) along = accumulated(poses, metres_between);
  if (step.degrees) along = accumulated(poses, radians_between);
  const double first = along.front();
  const double count = std::floor((along.back() - first) / size * (1.0 + 1e-12));
  if (!(count <= kMostPoses)) throw InputError("resample: the step is too small");
  Trajectory out;
  std::size_t i = 0;
  for (double k = 0.0; k <= count; k += 1.0) {
    const double at = std::min(first + k * size, along.back());
    while (i + 2 < along.size() && along[i + 1] < at) ++i;
    const StampedPose& a = poses[i];
    const StampedPose& b = poses[i + 1];
    const double length = along[i + 1] - along[i];
    const double u = length > 0.0 ? (at - along[i]) / length : 0.0;
    const double stamp = u == 0.0   ? a.stamp
                         : u == 1.0 ? b.stamp
                                    : a.stamp + u * (b.stamp - a.stamp);
    if (!out.empty() && !(stamp > out.back().stamp)) continue;  // below the resolution of stamps
    if (u == 0.0 || u == 1.0) {
      out.push_back(u == 0.0 ? a : b);
    } else {
      out.push_back({stamp, normalized(interpolate(a.world_from_body, b.world_from_body, u))});
    }
  }
  return out;
}

std::size_t poses_in_gaps(const Trajectory& poses, const Trajectory& result, double gap) {
  std::size_t out = 0;
  std::size_t i = 1;
  for (const StampedPose& pose : result) {
    while (i < poses.size() && poses[i].stamp <= pose.stamp) ++i;
    if (i == poses.size()) break;
    const double before = poses[i - 1].stamp;
    if (before < pose.stamp && poses[i].stamp - before > gap) ++out;
  }
  return out;
}

std::vector<std::size_t> lap_starts(const Trajectory& poses, double radius) {
  std::vector<std::size_t> out{0};
  const auto displacement = [&](std::size_t from, std::size_t to) -> Vector3 {
    return poses[to].world_from_body.translation - poses[from].world_from_body.translation;
  };
  const auto distance = [&](std::size_t i) { return displacement(0, i).norm(); };
  std::size_t i = 0;
  while (i < poses.size() && distance(i) <= radius) ++i;
  if (i == poses.size()) return out;
  const Vector3 departure = displacement(0, i);
  while (i < poses.size()) {
    while (i < poses.size() && distance(i) > radius) ++i;
    if (i == poses.size()) break;
    const std::size_t enters = i;
    std::size_t nearest = i;
    for (; i < poses.size() && distance(i) <= radius; ++i) {
      if (distance(i) < distance(nearest)) nearest = i;
    }
    const std::size_t leaves = std::min(i, poses.size() - 1);
    if (displacement(enters - 1, leaves).dot(departure) > 0.0) out.push_back(nearest);
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
