/// RGB-D odometry: every frame against the points that the last keyframes saw.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/rgbd/features/features.hpp"
#include "datasets/rgbd/features/matching.hpp"
#include "datasets/rgbd/tracking/camera_pose.hpp"
#include "datasets/rgbd/tracking/keyframe_rule.hpp"
#include "datasets/rgbd/tracking/local_map.hpp"

namespace loopbench {

struct TrackOptions {
  std::int64_t window = 10;
  std::int64_t inliers_min = 25;
  double restart_after = 1.0;  ///< [s]
  MatchOptions match;
  PoseOptions pose;
  KeyframeOptions keyframes;
};

template <class Visit>
void fields(TrackOptions& o, Visit visit) {
  visit("track.window", o.window, "keyframes whose points are kept", Between{1, 1000});
  visit("track.inliers_min", o.inliers_min, "fewer and the frame is lost", Between{6});
  visit("track.restart_after", o.restart_after, "lost so long: begin anew [s]", Between{0});
  fields(o.match, visit);
  fields(o.pose, visit);
  fields(o.keyframes, visit);
}

struct Keyframe {
  std::size_t frame = 0;  ///< of the source
  double stamp = 0.0;     ///< [s]
  Pose world_from_camera;
  Features features;
};

/// The world is the first keyframe's camera.
struct Tracked {
  std::vector<Keyframe> keyframes = {};
  std::vector<Edge> odometry = {};            ///< one a pair of neighbours
  std::vector<std::size_t> common_view = {};  ///< likewise
  Trajectory frames = {};                     ///< tracked frames that are no keyframe
  std::size_t lost = 0;                       ///< frames without a pose
  std::size_t skipped = 0;                    ///< frames that could not be read
  std::vector<std::string> notes = {};        ///< where tracking was lost, and what became of it
};

/// Feed every frame in order, then finish().
///
/// A frame's pose is predicted with constant velocity, points are sought near where they should
/// be (thrice as far when too few are found; when that fails too, the last keyframe's points by
/// looks alone), and found by RANSAC and Gauss-Newton, twice. Fewer than inliers_min: lost, the
/// frame has no pose. Lost for longer than restart_after: a new map is begun at the last pose,
/// joined to the old one by an edge that knows next to nothing (0.5 m, 0.5 rad), and said in the
/// notes.
class Tracker {
 public:
  Tracker(const Camera& camera, std::size_t frames, const TrackOptions& options)
      : camera_(camera), count_(frames), options_(options) {}

  void add(std::size_t frame, double stamp, Features features);

  /// Makes the last tracked frame a keyframe, if it is none. Call once.
  Tracked finish();

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
  std::vector<Match> everywhere(const Features& features) const;
  std::optional<Located> settle(const Features& features, const std::vector<Match>& matches) const;
  Pose predicted(double stamp) const;
  View view(const Located& here) const;
  void begin(std::size_t frame, double stamp, Features features);
  void miss(std::size_t frame, double stamp, Features features);
  void make_keyframe(Located here);

  Camera camera_;
  std::size_t count_;
  TrackOptions options_;
  Tracked out_;
  LocalMap map_;
  std::optional<Located> last_;    ///< tracked frame that is no keyframe
  Trajectory recent_;              ///< the last two poses, for the velocity
  std::optional<double> lost_at_;  ///< stamp of the first of a row of lost frames
  std::size_t lost_row_ = 0;
};

}  // namespace loopbench
