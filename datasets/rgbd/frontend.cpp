#include "datasets/rgbd/frontend.hpp"

#include <fmt/format.h>

#include "datasets/rgbd/cpu_clock.hpp"
#include "datasets/rgbd/loops/normalised_gap.hpp"
#include "datasets/rgbd/opencv.hpp"
#include "datasets/rgbd/ordered_pipeline.hpp"
#include "datasets/rgbd/pack_stages.hpp"
#include "datasets/rgbd/stage_cache.hpp"
#include "datasets/rgbd/tracking/focal_check.hpp"

namespace loopbench::rgbd {
namespace {

constexpr std::size_t kMinGaps = 8;  // minimum number of gaps for a meaningful median

double cpu_since(double begin) { return cpu_seconds() - begin; }

/// CPU time of the stages [s] and the number of items they processed.
struct StageTimes {
  double read = 0.0;
  double features = 0.0;
  double track = 0.0;
  double loops = 0.0;
  double refine = 0.0;
  std::size_t frames_read = 0;  ///< other frames were cached
  std::size_t frames_tracked = 0;
  std::size_t keyframes_searched = 0;
  std::size_t edges_refined = 0;
};

/// Features of a frame and the time to compute them.
struct TimedFeatures {
  FrameFeatures frame = {};
  double read = 0.0;      ///< [s]
  double find = 0.0;      ///< [s]
  bool computed = false;  ///< false: from the cache
};

/// Counts unreadable frames and formats notes about them, with the reasons of the first three.
class SkippedFrames {
 public:
  void add(const std::string& why) {
    ++count_;
    if (count_ <= kShown) notes_.push_back("skipped: " + why);
  }
  std::size_t count() const { return count_; }
  std::vector<std::string> notes(std::size_t frames) const {
    std::vector<std::string> out = notes_;
    if (count_ > kShown) out.push_back(fmt::format("skipped: {} more", count_ - kShown));
    if (count_ > 0) out.push_back(fmt::format("{} of {} frames skipped", count_, frames));
    return out;
  }

 private:
  static constexpr std::size_t kShown = 3;
  std::size_t count_ = 0;
  std::vector<std::string> notes_;
};

TrackingResult track(const RgbdSource& source,
                     const FrontendOptions& options,
                     const FrontendHooks& hooks,
                     const StageCache& cache,
                     StageTimes& seconds) {
  const Camera camera = source.camera();
  Tracker tracker(camera, source.size(), options.track);
  SkippedFrames skipped;
  const auto make = [&](std::size_t i) {
    TimedFeatures out;
    const auto describe_frame = [&] {
      FrameFeatures frame;
      out.computed = true;
      const double begin = cpu_seconds();
      const std::optional<RgbdFrame> images = source.read(i, frame.why);
      const double middle = cpu_seconds();
      out.read = middle - begin;
      if (images) frame.features = find_features(*images, camera, options.features);
      out.find = cpu_since(middle);
      return frame;
    };
    const auto pack = [](const FrameFeatures& frame) { return packed(frame); };
    out.frame = cache.get(cache.frame(i), deserialise_frame, describe_frame, pack);
    return out;
  };
  ordered_pipeline<TimedFeatures>(source.size(),
                                  hardware_threads(),
                                  4 * hardware_threads(),
                                  make,
                                  [&](std::size_t i, TimedFeatures timed) {
                                    seconds.read += timed.read;
                                    seconds.features += timed.find;
                                    seconds.frames_read += timed.computed ? 1 : 0;
                                    if (hooks.progress)
                                      hooks.progress("tracking", i + 1, source.size());
                                    if (!timed.frame.features) return skipped.add(timed.frame.why);
                                    const double begin = cpu_seconds();
                                    tracker.add(
                                        i, source.stamp(i), std::move(*timed.frame.features));
                                    seconds.track += cpu_since(begin);
                                  });
  seconds.frames_tracked = source.size();
  TrackingResult out = tracker.finish();
  const std::vector<std::string> notes = skipped.notes(source.size());
  out.notes.insert(out.notes.begin(), notes.begin(), notes.end());
  const FocalCheck focal = check_focal(out.keyframes, camera, options.track);
  if (auto warning = focal_warning(focal, camera)) out.notes.push_back(std::move(*warning));
  out.skipped = skipped.count();
  return out;
}

std::string throughput_note(const StageTimes& s) {
  std::string out;
  const auto rate = [&](std::size_t count, double seconds, const char* what) {
    if (count == 0) return;
    const double per_second = static_cast<double>(count) / std::max(seconds, 1e-9);
    out += fmt::format("{}{:.1f} {}", out.empty() ? "" : ", ", per_second, what);
  };
  rate(s.frames_read, s.read, "frames read or rendered");
  rate(s.frames_read, s.features, "described");
  rate(s.frames_tracked, s.track, "tracked");
  rate(s.keyframes_searched, s.loops, "keyframes searched for loops");
  rate(s.edges_refined, s.refine, "steps and loops measured again by depth");
  if (out.empty()) return "everything from the cache";
  return fmt::format("in a second of one core: {}; {} threads", out, hardware_threads());
}

DetectedLoops find_loops(const TrackingResult& tracked,
                         const RgbdSource& source,
                         const FrontendOptions& options,
                         const FrontendHooks& hooks,
                         const StageCache& cache,
                         StageTimes& seconds) {
  const auto make = [&] {
    seconds.keyframes_searched = options.loops.enabled ? tracked.keyframes.size() : 0;
    DetectedLoops out = detect_loops(tracked,
                                     source.camera(),
                                     options.track,
                                     options.loops,
                                     [&](std::size_t done, std::size_t all) {
                                       if (hooks.progress) hooks.progress("loops", done, all);
                                     });
    seconds.loops = out.seconds;
    return out;
  };
  const auto pack = [](const DetectedLoops& loops) { return packed(loops); };
  return cache.get(cache.loops(), deserialise_loops, make, pack);
}

/// Refines odometry and closures by depth and updates keyframes and frames. Returns the factor by
/// which the differences between feature-based and depth-based edges exceed their stated
/// uncertainty.
double refine(TrackingResult& tracked,
              DetectedLoops& loops,
              const RgbdSource& source,
              const FrontendOptions& options,
              const FrontendHooks& hooks,
              const StageCache& cache,
              StageTimes& seconds) {
  const auto make = [&] {
    RefinedEdges out = refine_by_depth(source,
                                       tracked,
                                       loops.closures,
                                       options.track.pose,
                                       options.features.depth_max,
                                       options.refine,
                                       [&](std::size_t done, std::size_t all) {
                                         if (hooks.progress) hooks.progress("depth", done, all);
                                       });
    seconds.refine = out.seconds;
    seconds.edges_refined = out.odometry.size() + out.closures.size();
    return out;
  };
  const auto pack = [](const RefinedEdges& edges) { return packed(edges); };
  RefinedEdges edges = cache.get(cache.refined(), deserialise_edges, make, pack);
  tracked.notes.push_back(fmt::format("measured again by depth: {} of {} steps, {} of {} loops",
                                      edges.odometry_refined,
                                      edges.odometry.size(),
                                      edges.closures_refined,
                                      edges.closures.size()));
  const double excess = repeated_measurement_excess(tracked.odometry, edges.odometry, kMinGaps);
  update_poses(tracked, edges.odometry);
  loops.closures = std::move(edges.closures);
  return excess;
}

/// Divides all information matrices by the factor by which loops disagree with odometry, or depth
/// with features, more than expected. Information is never increased, because errors common to both
/// cannot be detected.
void scale_information(TrackingResult& tracked, DetectedLoops& loops, double depth_excess) {
  const double loop_excess = information_excess(tracked.odometry, loops.closures, kMinGaps);
  const double excess = std::max(loop_excess, depth_excess);
  if (!(excess > 1.0)) return;
  for (Edge& edge : tracked.odometry) edge.information /= excess;
  for (Edge& edge : loops.closures) edge.information /= excess;
  tracked.notes.push_back(fmt::format(
      "{} disagree by more than their residuals indicate: information divided by {:.2f}",
      depth_excess > loop_excess ? "features and depth" : "loops and odometry",
      excess));
}

}  // namespace

Sequence run_frontend(const RgbdSource& source,
                      const std::string& name,
                      const FrontendOptions& options,
                      const FrontendHooks& hooks) {
  run_opencv_on_one_thread();
  const StageCache cache(hooks, source, options);
  std::optional<CacheLock> lock;  // workers of one sweep may load the same sequence concurrently
  if (!hooks.cache.empty()) lock.emplace(cache.tracked());
  StageTimes seconds;
  const auto make = [&] { return track(source, options, hooks, cache, seconds); };
  const auto pack = [](const TrackingResult& tracked) { return packed(tracked); };
  TrackingResult tracked = cache.get(cache.tracked(), deserialise_tracked, make, pack);
  const double skipped_share =
      static_cast<double>(tracked.skipped) / static_cast<double>(source.size());
  if (skipped_share > options.skipped_max) {
    throw InputError(
        fmt::format("{}: {} of {} frames cannot be read, expected at most skipped_max = {}; {}",
                    name,
                    tracked.skipped,
                    source.size(),
                    options.skipped_max,
                    tracked.notes.front()));
  }
  if (tracked.keyframes.size() < 2) {
    throw InputError(fmt::format(
        "{}: tracked fewer than 2 keyframes in {} frames; check the camera intrinsics and "
        "depth_scale",
        name,
        source.size()));
  }
  DetectedLoops loops = find_loops(tracked, source, options, hooks, cache, seconds);
  double depth_excess = 1.0;
  if (options.refine.depth) {
    depth_excess = refine(tracked, loops, source, options, hooks, cache, seconds);
  }
  scale_information(tracked, loops, depth_excess);

  Sequence out;
  out.name = name;
  out.provenance = source.provenance();
  std::vector<std::string>& notes = out.provenance.notes;
  notes.insert(notes.end(), tracked.notes.begin(), tracked.notes.end());
  notes.push_back(fmt::format("{} of {} frames tracked, {} lost; {} keyframes, {} loop closures",
                              tracked.keyframes.size() + tracked.frames.size(),
                              source.size(),
                              tracked.lost,
                              tracked.keyframes.size(),
                              loops.closures.size()));
  notes.push_back(throughput_note(seconds));
  for (const Keyframe& keyframe : tracked.keyframes) {
    out.problem.keyframes.push_back({keyframe.stamp, keyframe.world_from_camera});
  }
  out.problem.odometry = std::move(tracked.odometry);
  out.problem.shared_landmarks = std::move(tracked.shared_landmarks);
  out.problem.frames = std::move(tracked.frames);
  out.problem.closures = std::move(loops.closures);
  out.reference = source.reference();
  out.loop_candidates = std::move(loops.candidates);
  out.provenance.closures =
      out.problem.closures.empty() ? "none" : "images: bag of words and geometry";
  return out;
}

}  // namespace loopbench::rgbd
