/// RGB-D odometry: tracking of each frame against a local map.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/rgbd/features/features.hpp"
#include "datasets/rgbd/features/matching.hpp"
#include "datasets/rgbd/tracking/camera_pose.hpp"
#include "datasets/rgbd/tracking/keyframe_rule.hpp"
#include "datasets/rgbd/tracking/local_map.hpp"

namespace loopbench::rgbd {

struct TrackOptions {
  std::int64_t window = 10;
  std::int64_t inliers_min = 25;
  double restart_after = 1.0;  ///< [s]
  std::int64_t keyframes_target = 0;
};

template <class Visit>
void fields(TrackOptions& o, Visit visit) {
  visit("track.window", o.window, "number of keyframes in the local map", Between{1, 1000});
  visit("track.inliers_min",
        o.inliers_min,
        "minimum number of inliers of a tracked frame",
        Between{6});
  visit("track.restart_after",
        o.restart_after,
        "duration of a tracking loss after which a new map is started [s]",
        Between{0});
  visit("keyframes.target",
        o.keyframes_target,
        "approximate number of keyframes; 0: determined by motion and visible features",
        Between{0});
}

struct Keyframe {
  std::size_t frame = 0;  ///< frame index in the source
  double stamp = 0.0;     ///< [s]
  Pose world_from_camera;
  Features features;
};

/// Result of tracking. The world frame is the camera frame of the first keyframe.
struct TrackingResult {
  std::vector<Keyframe> keyframes = {};
  std::vector<Edge> odometry = {};                 ///< one per pair of consecutive keyframes
  std::vector<std::size_t> shared_landmarks = {};  ///< points common to these keyframes
  Trajectory frames = {};                          ///< tracked frames that are not keyframes
  std::size_t lost = 0;                            ///< number of frames without a pose
  std::size_t skipped = 0;                         ///< number of frames that could not be read
  std::vector<std::string> notes = {};             ///< tracking losses and recoveries
};

/// Tracks an RGB-D camera. Call add() for each frame in order, then finish().
///
/// The pose of a frame is predicted with constant velocity. Map points are matched near their
/// predicted projection, with a three times larger radius if there are few matches, or with the
/// points of the last keyframe by descriptor only if this fails. The pose is estimated by RANSAC
/// and Gauss-Newton, followed by a second guided matching. A frame with fewer than inliers_min
/// inliers is lost and has no pose. After a loss of restart_after, a new map is started at the last
/// pose. It is connected to the old one by an edge with standard deviations of 0.5 m and 0.5 rad,
/// and a note is added.
class Tracker {
 public:
  Tracker(const Camera& camera, std::size_t frames, const TrackOptions& options)
      : camera_(camera), count_(frames), options_(options) {}

  void add(std::size_t frame, double stamp, Features features);

  /// Returns the result. The last tracked frame becomes a keyframe. Call once.
  TrackingResult finish();

 private:
  struct Located {
    std::size_t frame = 0;
    double stamp = 0.0;
    Features features = {};
    Pose world_from_camera = {};
    Matrix6 information = Matrix6::Zero();
    std::vector<Match> matches = {};
  };

  std::optional<Located> locate(const Features& features, const Pose& prediction) const;
  std::vector<Match> match_last_keyframe(const Features& features) const;
  std::optional<Located> estimate_pose(const Features& features,
                                       const std::vector<Match>& matches) const;
  Pose predicted(double stamp) const;
  FrameRelation view(const Located& located) const;
  void start_map(std::size_t frame, double stamp, Features features);
  void handle_lost_frame(std::size_t frame, double stamp, Features features);
  void make_keyframe(Located located);

  Camera camera_;
  std::size_t count_;
  TrackOptions options_;
  TrackingResult out_;
  LocalMap map_;
  std::optional<Located> last_;       ///< last tracked frame if it is not a keyframe
  Trajectory recent_;                 ///< the last two poses, for the velocity
  std::optional<double> lost_since_;  ///< stamp of the first of consecutive lost frames
  std::size_t lost_count_ = 0;        ///< number of consecutive lost frames
};

}  // namespace loopbench::rgbd
