#include "datasets/rgbd/loops/verify.hpp"

#include <algorithm>

#include "datasets/rgbd/tracking/observations.hpp"

namespace loopbench::rgbd {
namespace {

constexpr std::size_t kNeighbours = 1;   // keyframes on each side whose points are used
constexpr std::size_t kMinMatches = 12;  // for RANSAC
constexpr double kRadius = 0.02;         // of the guided search relative to the image width

/// Appends the points of a keyframe, transformed by `world_from_camera`, and their descriptors.
void collect(const Keyframe& keyframe,
             const Pose& world_from_camera,
             const Camera& camera,
             std::vector<MapPoint>& points,
             Features& descriptors) {
  const Features& f = keyframe.features;
  descriptors.bytes = f.bytes;
  descriptors.binary = f.binary;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const Feature& point = f.points[i];
    if (!(point.depth > 0.0f)) continue;
    const Vector3 in_camera = camera.back_project(static_cast<double>(point.u),
                                                  static_cast<double>(point.v),
                                                  static_cast<double>(point.depth));
    points.push_back({world_from_camera * in_camera, point.octave, points.size()});
    descriptors.points.push_back(point);
    descriptors.descriptors.insert(
        descriptors.descriptors.end(), f.descriptor(i), f.descriptor(i) + f.bytes);
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
  const Features& query = keyframes[to].features;
  std::vector<MapPoint> points;
  Features descriptors;
  collect(keyframes[from], {}, camera, points, descriptors);
  const std::vector<Match> wide = match_exhaustive(descriptors, query, options.match);
  if (wide.size() < kMinMatches) return out;
  const std::vector<Observation> first = observations(points, query, wide);
  const std::optional<Pose> found = pose_by_ransac(first, camera, options.pose);
  if (!found) return out;
  const RefinedPose rough = refine_pose(first, camera, *found, options.pose);
  if (rough.inliers < kMinMatches / 2) return out;

  const Pose from_from_world = keyframes[from].world_from_camera.inverse();
  const std::size_t last = std::min(from + kNeighbours, to - 1);
  for (std::size_t k = from - std::min(from, kNeighbours); k <= last; ++k) {
    if (k == from) continue;
    collect(keyframes[k],
            from_from_world * keyframes[k].world_from_camera,
            camera,
            points,
            descriptors);
  }
  const std::vector<Match> near = match_guided(points,
                                               descriptors,
                                               query,
                                               camera,
                                               rough.world_from_camera,
                                               kRadius * camera.width,
                                               options.match);
  const RefinedPose pose =
      refine_pose(observations(points, query, near), camera, rough.world_from_camera, options.pose);
  if (pose.inliers < 6) return out;
  out.edge.from_from_to = pose.world_from_camera;
  out.edge.information = pose.information;
  out.inliers = pose.inliers;
  out.share = static_cast<double>(pose.inliers) / static_cast<double>(near.size());
  return out;
}

}  // namespace loopbench::rgbd
