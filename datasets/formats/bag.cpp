#include <algorithm>
#include <cmath>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/format_registry.hpp"

namespace loopbench {
namespace {

bool is_same_pose(const PoseMessage& a, const PoseMessage& b) {
  return a.nanoseconds == b.nanoseconds &&
         a.frame_from_child.translation == b.frame_from_child.translation &&
         a.frame_from_child.rotation.coeffs() == b.frame_from_child.rotation.coeffs();
}

TrajectoryFile read_bag_file(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string name = file.string();
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
      const bool is_refused = options.repeats == Repeats::refuse;
      if (is_refused && agrees_with_last(out.poses, pose.frame_from_child)) {
        ++findings.agreeing;
        continue;
      }
      if (is_refused) {
        throw InputError(name + ": stamp " + seconds_text(pose.nanoseconds) +
                         " has two poses, expected increasing stamps (--repeats keep_first or "
                         "keep_last, or repeats: in a config)");
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
  if (bag.is_geodetic) out.poses = local_positions(std::move(out.poses), options, findings);
  if (options.findings) *options.findings = findings;
  return out;
}

bool is_bag(const std::filesystem::path& file) {
  return names_bag(file.string()) || bag_kind(open_input(file)) != BagKind::none;
}

}  // namespace

FormatEntry bag_format() {
  return {.format = Format::bag, .guess_file = is_bag, .read_file = read_bag_file};
}

}  // namespace loopbench
