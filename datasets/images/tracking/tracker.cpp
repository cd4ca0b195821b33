#include "datasets/images/tracking/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/core/upper_median.hpp"
#include "datasets/derive/odometry.hpp"
#include "datasets/images/tracking/camera_pose.hpp"

namespace loopbench::rgbd {
namespace {

constexpr std::size_t kFewMatches = 40;  // below, the search radius is increased
constexpr double kWider = 3.0;           // factor on the radius for few matches
constexpr double kNarrower = 0.2;        // factor on the radius of the second search
constexpr std::size_t kMinInitialPoints = 50;
constexpr double kMaxVelocityAge = 0.5;  // [s]
constexpr double kGuess = 0.5;           // standard deviation of an unmeasured edge [m], [rad]

double median_depth(const Features& features) {
  std::vector<float> depths;
  for (const Feature& f : features.points) {
    if (f.depth > 0.0f) depths.push_back(f.depth);
  }
  if (depths.empty()) return 1.0;
  return static_cast<double>(upper_median(depths));
}

}  // namespace

Pose Tracker::predicted(double stamp) const {
  if (recent_.empty()) return {};
  const StampedPose& last = recent_.back();
  if (recent_.size() < 2 || stamp - last.stamp > kMaxVelocityAge) return last.world_from_body;
  const StampedPose& before = recent_[recent_.size() - 2];
  const double share = (stamp - last.stamp) / (last.stamp - before.stamp);
  const Twist step = log_se3(before.world_from_body.inverse() * last.world_from_body);
  return normalized(last.world_from_body * exp_se3(share * step));
}

std::optional<Tracker::Located> Tracker::estimate_pose(const Features& features,
                                                       const std::vector<Match>& matches) const {
  const auto min_inliers = static_cast<std::size_t>(options_.inliers_min);
  if (matches.size() < min_inliers) return std::nullopt;
  const std::vector<Observation> first = observations(map_.points(), features, matches);
  const std::optional<Pose> found = pose_by_ransac(first, camera_);
  if (!found) return std::nullopt;
  const RefinedPose initial = refine_pose(first, camera_, *found);
  if (initial.inliers < min_inliers / 2) return std::nullopt;

  const double radius = kNarrower * kMatchRadius * camera_.width;
  std::vector<Match> guided = match_guided(
      map_.points(), map_.descriptors(), features, camera_, initial.world_from_camera, radius);
  const RefinedPose pose = refine_pose(
      observations(map_.points(), features, guided), camera_, initial.world_from_camera);
  if (pose.inliers < min_inliers) return std::nullopt;
  Located out;
  out.world_from_camera = pose.world_from_camera;
  out.information = pose.information;
  for (std::size_t i = 0; i < guided.size(); ++i) {
    if (pose.inlier[i]) out.matches.push_back(guided[i]);
  }
  return out;
}

std::optional<Tracker::Located> Tracker::locate(const Features& features,
                                                const Pose& prediction) const {
  const auto near = [&](double wider) {
    return match_guided(map_.points(),
                        map_.descriptors(),
                        features,
                        camera_,
                        prediction,
                        wider * kMatchRadius * camera_.width);
  };
  std::vector<Match> matches = near(1.0);
  if (matches.size() < kFewMatches) matches = near(kWider);
  if (auto found = estimate_pose(features, matches)) return found;
  return estimate_pose(features, match_last_keyframe(features));
}

std::vector<Match> Tracker::match_last_keyframe(const Features& features) const {
  const std::vector<std::size_t> recent = map_.points_last_seen_in(out_.keyframes.size() - 1);
  Features candidates;
  candidates.bytes = map_.descriptors().bytes;
  candidates.binary = map_.descriptors().binary;
  for (const std::size_t k : recent) {
    const std::uint8_t* row = map_.descriptors().descriptor(k);
    candidates.points.push_back(map_.descriptors().points[k]);
    candidates.descriptors.insert(candidates.descriptors.end(), row, row + candidates.bytes);
  }
  std::vector<Match> out = match_exhaustive(candidates, features);
  for (Match& match : out) match.a = recent[match.a];
  return out;
}

FrameRelation Tracker::view(const Located& located) const {
  const std::size_t last = out_.keyframes.size() - 1;
  const Keyframe& keyframe = out_.keyframes.back();
  FrameRelation view;
  for (std::size_t k = 0; k < map_.points().size(); ++k) {
    if (map_.last_keyframe_of(k) == last) ++view.points;
  }
  for (const Match& match : located.matches) {
    if (map_.last_keyframe_of(match.a) == last) ++view.common;
  }
  const Pose step = keyframe.world_from_camera.inverse() * located.world_from_camera;
  view.distance = step.translation.norm();
  view.angle = log_so3(step.rotation).norm();
  view.depth = median_depth(located.features);
  view.time = located.stamp - keyframe.stamp;
  return view;
}

void Tracker::make_keyframe(Located located) {
  const std::size_t index = out_.keyframes.size();
  if (index > 0) {
    out_.shared_landmarks.push_back(view(located).common);
    const Pose step = out_.keyframes.back().world_from_camera.inverse() * located.world_from_camera;
    out_.odometry.push_back({index - 1, index, normalized(step), located.information});
  }
  map_.add(index,
           static_cast<std::size_t>(options_.window),
           located.features,
           located.matches,
           camera_,
           located.world_from_camera);
  out_.keyframes.push_back(
      {located.frame, located.stamp, located.world_from_camera, std::move(located.features)});
  last_.reset();
}

void Tracker::start_map(std::size_t frame, double stamp, Features features) {
  const auto with_depth =
      std::ranges::count_if(features.points, [](const Feature& f) { return f.depth > 0.0f; });
  if (static_cast<std::size_t>(with_depth) < kMinInitialPoints) {
    ++out_.lost;
    return;
  }
  Located located;
  located.frame = frame;
  located.stamp = stamp;
  located.features = std::move(features);
  if (!recent_.empty()) located.world_from_camera = recent_.back().world_from_body;
  located.information = isotropic_information(kGuess * kGuess, kGuess * kGuess);
  if (lost_since_) {
    out_.notes.push_back(fmt::format(
        "tracking lost at {:.3f} s and not recovered: restarted at {:.3f} s; the motion "
        "in between is assumed",
        *lost_since_,
        stamp));
  }
  lost_since_.reset();
  lost_count_ = 0;
  map_.clear();
  recent_ = {{stamp, located.world_from_camera}};
  make_keyframe(std::move(located));
}

void Tracker::handle_lost_frame(std::size_t frame, double stamp, Features features) {
  if (!lost_since_) lost_since_ = stamp;
  if (stamp - *lost_since_ >= options_.restart_after) {
    if (last_) {  // the last tracked frame becomes the last keyframe of the old map
      out_.frames.pop_back();
      make_keyframe(std::move(*last_));
    }
    start_map(frame, stamp, std::move(features));
    return;
  }
  ++lost_count_;
  ++out_.lost;
}

void Tracker::add(std::size_t frame, double stamp, Features features) {
  if (out_.keyframes.empty()) return start_map(frame, stamp, std::move(features));
  std::optional<Located> located = locate(features, predicted(stamp));
  if (!located) return handle_lost_frame(frame, stamp, std::move(features));
  located->frame = frame;
  located->stamp = stamp;
  located->features = std::move(features);
  if (lost_since_) {
    out_.notes.push_back(
        fmt::format("tracking lost at {:.3f} s, recovered at {:.3f} s: {} frames "
                    "have no pose",
                    *lost_since_,
                    stamp,
                    lost_count_));
    lost_since_.reset();
    lost_count_ = 0;
  }
  if (recent_.size() == 2) recent_.erase(recent_.begin());
  recent_.push_back({stamp, located->world_from_camera});
  const double due = novelty_due(options_.keyframes_target, out_.keyframes.size(), frame, count_);
  // Independent of the target: with fewer matches tracking may be lost in the next frame.
  const bool few_matches =
      located->matches.size() < 2 * static_cast<std::size_t>(options_.inliers_min);
  if (few_matches || novelty(view(*located)) >= due) {
    make_keyframe(std::move(*located));
  } else {
    out_.frames.push_back({stamp, located->world_from_camera});
    last_ = std::move(located);
  }
}

TrackingResult Tracker::finish() {
  if (lost_since_) {
    out_.notes.push_back(
        fmt::format("tracking lost at {:.3f} s until the end: {} frames have no pose",
                    *lost_since_,
                    lost_count_));
  }
  if (last_) {
    out_.frames.pop_back();
    make_keyframe(std::move(*last_));
  }
  return std::move(out_);
}

}  // namespace loopbench::rgbd
