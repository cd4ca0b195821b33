#include "datasets/rgbd/loops/verify.hpp"

#include <algorithm>

#include "datasets/rgbd/tracking/observations.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kNeighbours = 1;  // on each side, whose points help
constexpr std::size_t kFewest = 12;     // matches worth a RANSAC
constexpr double kRadius = 0.02;        // of the second search, over image width

/// Points of one keyframe where another stands in the middle of the world.
void collect(const Keyframe& keyframe,
             const Pose& world_from_camera,
             const Camera& camera,
             std::vector<Seen>& points,
             Features& looks) {
  const Features& f = keyframe.features;
  looks.bytes = f.bytes;
  looks.binary = f.binary;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const Feature& point = f.points[i];
    if (!(point.depth > 0.0f)) continue;
    const Vector3 here = camera.back_project(static_cast<double>(point.u),
                                             static_cast<double>(point.v),
                                             static_cast<double>(point.depth));
    points.push_back({world_from_camera * here, point.octave, points.size()});
    looks.points.push_back(point);
    looks.descriptors.insert(looks.descriptors.end(), f.descriptor(i), f.descriptor(i) + f.bytes);
  }
}

}  // namespace

Verified verify(const std::vector<Keyframe>& keyframes,
                std::size_t from,
                std::size_t to,
                const Camera& camera,
                const TrackOptions& options) {
  Verified out;
  out.edge.from = from;
  out.edge.to = to;
  const Features& here = keyframes[to].features;
  std::vector<Seen> points;
  Features looks;
  collect(keyframes[from], {}, camera, points, looks);
  const std::vector<Match> wide = match_everywhere(looks, here, options.match);
  if (wide.size() < kFewest) return out;
  const std::vector<Observation> first = observations(points, here, wide);
  const std::optional<Pose> found = pose_by_ransac(first, camera, options.pose);
  if (!found) return out;
  const RefinedPose rough = refine_pose(first, camera, *found, options.pose);
  if (rough.inliers < kFewest / 2) return out;

  const Pose from_from_world = keyframes[from].world_from_camera.inverse();
  const std::size_t last = std::min(from + kNeighbours, to - 1);
  for (std::size_t k = from - std::min(from, kNeighbours); k <= last; ++k) {
    if (k == from) continue;
    collect(keyframes[k], from_from_world * keyframes[k].world_from_camera, camera, points, looks);
  }
  const std::vector<Match> near = match_near(
      points, looks, here, camera, rough.world_from_camera, kRadius * camera.width, options.match);
  const RefinedPose pose =
      refine_pose(observations(points, here, near), camera, rough.world_from_camera, options.pose);
  if (pose.inliers < 6) return out;
  out.edge.from_from_to = pose.world_from_camera;
  out.edge.information = pose.information;
  out.inliers = pose.inliers;
  out.share = static_cast<double>(pose.inliers) / static_cast<double>(near.size());
  return out;
}

}  // namespace loopbench
