/// RGB-D odometry: tracking of each frame against a local map.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/images/features/features.hpp"
#include "datasets/images/features/matching.hpp"
#include "datasets/images/tracking/camera_pose.hpp"
#include "datasets/images/tracking/local_map.hpp"

namespace loopbench::rgbd {

/// Relation of a frame to the last keyframe.
struct FrameRelation {
  std::size_t points = 0;  ///< number of points observed in the keyframe
  std::size_t common = 0;  ///< number of these points also observed in the frame
  double distance = 0.0;   ///< distance between the two [m]
  double depth = 1.0;      ///< median depth of the frame [m]
  double angle = 0.0;      ///< rotation angle between the two [rad]
  double time = 0.0;       ///< time between the two [s]
};

inline constexpr double kMinTrackedShare = 0.2;  // of the points of the last keyframe [-]
inline constexpr double kMinCommonPoints = 60.0;
inline constexpr double kMaxParallax = 0.15;  // distance over median depth [-]
inline constexpr double kMaxAngle = 15.0;     // [deg]
inline constexpr double kMaxTime = 2.0;       // [s]

/// Maximum over all criteria of the ratio of value and threshold. A frame becomes a keyframe if
/// this reaches novelty_due().
inline double novelty(const FrameRelation& view) {
  const double common = static_cast<double>(view.common);
  const double share = view.points == 0 ? 0.0 : common / static_cast<double>(view.points);
  return std::max({(1.0 - share) / (1.0 - kMinTrackedShare),
                   kMinCommonPoints / std::max(common, 1.0),
                   view.distance / std::max(view.depth, 0.1) / kMaxParallax,
                   view.angle * 180.0 / std::numbers::pi / kMaxAngle,
                   view.time / kMaxTime});
}

/// Novelty threshold for a new keyframe. With a `target` above 0 it doubles for each keyframe (of
/// `selected`) above the number planned up to `frame` of `frames`, and halves for each missing one;
/// otherwise 1.
inline double novelty_due(std::int64_t target,
                          std::size_t selected,
                          std::size_t frame,
                          std::size_t frames) {
  if (target == 0 || frames < 2) return 1.0;
  constexpr double kFactor = 2.0;
  const double share = static_cast<double>(frame) / static_cast<double>(frames - 1);
  const double planned = 1.0 + share * static_cast<double>(target - 1);
  return std::pow(kFactor, static_cast<double>(selected) - planned);
}

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
