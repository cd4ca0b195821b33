#include "datasets/rgbd/tracking/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/derive/odometry.hpp"
#include "datasets/rgbd/tracking/observations.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kFewMatches = 40;  // a circle that holds fewer is widened
constexpr double kWider = 3.0;           // by so much
constexpr double kNarrower = 0.2;        // second search, about the pose found first
constexpr std::size_t kPointsToBegin = 50;
constexpr double kVelocityHolds = 0.5;  // a velocity older than this says nothing [s]
constexpr double kGuess = 0.5;          // of an edge that was not measured [m], [rad]

double median_depth(const Features& features) {
  std::vector<float> depths;
  for (const Feature& f : features.points) {
    if (f.depth > 0.0f) depths.push_back(f.depth);
  }
  if (depths.empty()) return 1.0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle);
}

}  // namespace

Pose Tracker::predicted(double stamp) const {
  if (recent_.empty()) return {};
  const StampedPose& last = recent_.back();
  if (recent_.size() < 2 || stamp - last.stamp > kVelocityHolds) return last.world_from_body;
  const StampedPose& before = recent_[recent_.size() - 2];
  const double share = (stamp - last.stamp) / (last.stamp - before.stamp);
  const Twist step = log_se3(before.world_from_body.inverse() * last.world_from_body);
  return normalized(last.world_from_body * exp_se3(share * step));
}

std::optional<Tracker::Located> Tracker::settle(const Features& features,
                                                const std::vector<Match>& matches) const {
  const auto least = static_cast<std::size_t>(options_.inliers_min);
  if (matches.size() < least) return std::nullopt;
  const std::vector<Observation> first = observations(map_.points(), features, matches);
  const std::optional<Pose> found = pose_by_ransac(first, camera_, options_.pose);
  if (!found) return std::nullopt;
  const RefinedPose near = refine_pose(first, camera_, *found, options_.pose);
  if (near.inliers < least / 2) return std::nullopt;

  const double radius = kNarrower * options_.match.radius * camera_.width;
  std::vector<Match> again = match_near(map_.points(),
                                        map_.looks(),
                                        features,
                                        camera_,
                                        near.world_from_camera,
                                        radius,
                                        options_.match);
  const RefinedPose pose = refine_pose(
      observations(map_.points(), features, again), camera_, near.world_from_camera, options_.pose);
  if (pose.inliers < least) return std::nullopt;
  Located out;
  out.world_from_camera = pose.world_from_camera;
  out.information = pose.information;
  for (std::size_t i = 0; i < again.size(); ++i) {
    if (pose.inlier[i]) out.matches.push_back(again[i]);
  }
  return out;
}

std::optional<Tracker::Located> Tracker::locate(const Features& features,
                                                const Pose& prediction) const {
  const auto near = [&](double wider) {
    return match_near(map_.points(),
                      map_.looks(),
                      features,
                      camera_,
                      prediction,
                      wider * options_.match.radius * camera_.width,
                      options_.match);
  };
  std::vector<Match> matches = near(1.0);
  if (matches.size() < kFewMatches) matches = near(kWider);
  if (auto found = settle(features, matches)) return found;
  return settle(features, everywhere(features));
}

std::vector<Match> Tracker::everywhere(const Features& features) const {
  const std::vector<std::size_t> seen = map_.seen_by(out_.keyframes.size() - 1);
  Features looks;
  looks.bytes = map_.looks().bytes;
  looks.binary = map_.looks().binary;
  for (const std::size_t k : seen) {
    const std::uint8_t* row = map_.looks().descriptor(k);
    looks.points.push_back(map_.looks().points[k]);
    looks.descriptors.insert(looks.descriptors.end(), row, row + looks.bytes);
  }
  std::vector<Match> out = match_everywhere(looks, features, options_.match);
  for (Match& match : out) match.a = seen[match.a];
  return out;
}

View Tracker::view(const Located& here) const {
  const std::size_t last = out_.keyframes.size() - 1;
  const Keyframe& keyframe = out_.keyframes.back();
  View view;
  for (std::size_t k = 0; k < map_.points().size(); ++k) {
    if (map_.last_seen(k) == last) ++view.points;
  }
  for (const Match& match : here.matches) {
    if (map_.last_seen(match.a) == last) ++view.common;
  }
  const Pose step = keyframe.world_from_camera.inverse() * here.world_from_camera;
  view.way = step.translation.norm();
  view.angle = log_so3(step.rotation).norm();
  view.depth = median_depth(here.features);
  view.time = here.stamp - keyframe.stamp;
  return view;
}

void Tracker::make_keyframe(Located here) {
  const std::size_t index = out_.keyframes.size();
  if (index > 0) {
    out_.common_view.push_back(view(here).common);
    const Pose step = out_.keyframes.back().world_from_camera.inverse() * here.world_from_camera;
    out_.odometry.push_back({index - 1, index, normalized(step), here.information});
  }
  map_.add(index,
           static_cast<std::size_t>(options_.window),
           here.features,
           here.matches,
           camera_,
           here.world_from_camera);
  out_.keyframes.push_back(
      {here.frame, here.stamp, here.world_from_camera, std::move(here.features)});
  last_.reset();
}

void Tracker::begin(std::size_t frame, double stamp, Features features) {
  const auto deep =
      std::ranges::count_if(features.points, [](const Feature& f) { return f.depth > 0.0f; });
  if (static_cast<std::size_t>(deep) < kPointsToBegin) {
    ++out_.lost;
    return;
  }
  Located here;
  here.frame = frame;
  here.stamp = stamp;
  here.features = std::move(features);
  if (!recent_.empty()) here.world_from_camera = recent_.back().world_from_body;
  here.information = isotropic_information(kGuess * kGuess, kGuess * kGuess);
  if (lost_at_) {
    out_.notes.push_back(
        fmt::format("tracking lost at {:.3f} s and not recovered: begun anew at {:.3f} s; the step "
                    "between is a guess",
                    *lost_at_,
                    stamp));
  }
  lost_at_.reset();
  lost_row_ = 0;
  map_.clear();
  recent_ = {{stamp, here.world_from_camera}};
  make_keyframe(std::move(here));
}

void Tracker::miss(std::size_t frame, double stamp, Features features) {
  if (!lost_at_) lost_at_ = stamp;
  if (stamp - *lost_at_ >= options_.restart_after) {
    if (last_) {  // what was tracked last closes the old map
      out_.frames.pop_back();
      make_keyframe(std::move(*last_));
    }
    begin(frame, stamp, std::move(features));
    return;
  }
  ++lost_row_;
  ++out_.lost;
}

void Tracker::add(std::size_t frame, double stamp, Features features) {
  if (out_.keyframes.empty()) return begin(frame, stamp, std::move(features));
  std::optional<Located> here = locate(features, predicted(stamp));
  if (!here) return miss(frame, stamp, std::move(features));
  here->frame = frame;
  here->stamp = stamp;
  here->features = std::move(features);
  if (lost_at_) {
    out_.notes.push_back(
        fmt::format("tracking lost at {:.3f} s, recovered at {:.3f} s: {} frames "
                    "have no pose",
                    *lost_at_,
                    stamp,
                    lost_row_));
    lost_at_.reset();
    lost_row_ = 0;
  }
  if (recent_.size() == 2) recent_.erase(recent_.begin());
  recent_.push_back({stamp, here->world_from_camera});
  const double due = novelty_due(options_.keyframes, out_.keyframes.size(), frame, count_);
  // However few are wanted: with so little left to hold on to the next frame would be lost.
  const bool slipping = here->matches.size() < 2 * static_cast<std::size_t>(options_.inliers_min);
  if (slipping || novelty(view(*here), options_.keyframes) >= due) {
    make_keyframe(std::move(*here));
  } else {
    out_.frames.push_back({stamp, here->world_from_camera});
    last_ = std::move(here);
  }
}

Tracked Tracker::finish() {
  if (lost_at_) {
    out_.notes.push_back(fmt::format(
        "tracking lost at {:.3f} s until the end: {} frames have no pose", *lost_at_, lost_row_));
  }
  if (last_) {
    out_.frames.pop_back();
    make_keyframe(std::move(*last_));
  }
  return std::move(out_);
}

}  // namespace loopbench
