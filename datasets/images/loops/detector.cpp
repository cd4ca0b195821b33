#include "datasets/images/loops/detector.hpp"

#include <algorithm>

#include "datasets/images/frames/ordered_pipeline.hpp"
#include "datasets/images/loops/retrieval.hpp"
#include "datasets/images/tracking/camera_pose.hpp"

namespace loopbench::rgbd {
namespace {

struct Verified {
  Edge edge;
  std::size_t inliers = 0;
  double share = 0.0;  ///< share of inliers among guided matches [-]
};

constexpr std::size_t kNeighbours = 1;   // keyframes on each side whose points are used
constexpr std::size_t kMinMatches = 12;  // for RANSAC
constexpr double kMinShare = 0.4;        // of inliers among guided matches of an accepted closure
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
    points.push_back({world_from_camera * point_of(point, camera), point.octave, points.size()});
    descriptors.points.push_back(point);
    descriptors.descriptors.insert(
        descriptors.descriptors.end(), f.descriptor(i), f.descriptor(i) + f.bytes);
  }
}

/// Estimates the pose of keyframe `to` in the frame of keyframe `from`, from the points of `from`
/// and then also of its neighbours, which are transformed by odometry. Zero inliers if no pose is
/// found. O(features^2).
Verified verify(const std::vector<Keyframe>& keyframes,
                std::size_t from,
                std::size_t to,
                const Camera& camera) {
  Verified out;
  out.edge.from = from;
  out.edge.to = to;
  const Features& query = keyframes[to].features;
  std::vector<MapPoint> points;
  Features descriptors;
  collect(keyframes[from], {}, camera, points, descriptors);
  const std::vector<Match> wide = match_exhaustive(descriptors, query);
  if (wide.size() < kMinMatches) return out;
  const std::vector<Observation> first = observations(points, query, wide);
  const std::optional<Pose> found = pose_by_ransac(first, camera);
  if (!found) return out;
  const RefinedPose rough = refine_pose(first, camera, *found);
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
  const std::vector<Match> near = match_guided(
      points, descriptors, query, camera, rough.world_from_camera, kRadius * camera.width);
  const RefinedPose pose =
      refine_pose(observations(points, query, near), camera, rough.world_from_camera);
  if (pose.inliers < 6) return out;
  out.edge.from_from_to = pose.world_from_camera;
  out.edge.information = pose.information;
  out.inliers = pose.inliers;
  out.share = static_cast<double>(pose.inliers) / static_cast<double>(near.size());
  return out;
}

struct Best {
  Verified verified;
  double score = -1.0;
};

}  // namespace

DetectedLoops detect_loops(const TrackingResult& tracked,
                           const Camera& camera,
                           const LoopOptions& options,
                           const std::function<void(std::size_t, std::size_t)>& progress) {
  DetectedLoops out;
  if (!options.enabled) return out;
  const std::vector<Keyframe>& keyframes = tracked.keyframes;
  const auto candidates = retrieve(keyframes, options.min_gap);
  const auto best_of = [&](std::size_t k) {
    Best best;
    for (const RetrievedKeyframe& candidate : candidates[k]) {
      Verified verified = verify(keyframes, candidate.keyframe, k, camera);
      const double score =
          static_cast<double>(verified.inliers) + std::min(1.0, candidate.similarity);
      if (score > best.score) best = {std::move(verified), score};
    }
    return best;
  };
  ordered_pipeline<Best>(keyframes.size(),
                         hardware_threads(),
                         4 * hardware_threads(),
                         best_of,
                         [&](std::size_t k, const Best& best) {
                           progress(k + 1, keyframes.size());
                           if (best.score < 0.0) return;
                           const Verified& loop = best.verified;
                           const bool accepted =
                               loop.inliers >= static_cast<std::size_t>(options.inliers_min) &&
                               loop.share >= kMinShare;
                           out.candidates.push_back({loop.edge.from, k, best.score, accepted});
                           if (accepted) out.closures.push_back(loop.edge);
                         });
  return out;
}

}  // namespace loopbench::rgbd
