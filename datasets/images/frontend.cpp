#include "datasets/images/frontend.hpp"

#include <fmt/format.h>

#include "datasets/images/frames/ordered_pipeline.hpp"
#include "datasets/images/loops/normalised_gap.hpp"
#include "datasets/images/opencv.hpp"

namespace loopbench::rgbd {
namespace {

/// Features of a frame, or the reason why it could not be read.
struct FrameFeatures {
  std::optional<Features> features = std::nullopt;
  std::string why = {};
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
                     const FrontendProgress& progress) {
  const Camera camera = source.camera();
  Tracker tracker(camera, source.size(), options.track);
  SkippedFrames skipped;
  const auto describe_frame = [&](std::size_t i) {
    FrameFeatures frame;
    const std::optional<RgbdFrame> images = source.read(i, frame.why);
    if (images) frame.features = find_features(*images, camera, options.features);
    return frame;
  };
  const auto track_frame = [&](std::size_t i, FrameFeatures frame) {
    if (progress) progress("tracking", i + 1, source.size());
    if (!frame.features) return skipped.add(frame.why);
    tracker.add(i, source.stamp(i), std::move(*frame.features));
  };
  ordered_pipeline<FrameFeatures>(
      source.size(), hardware_threads(), 4 * hardware_threads(), describe_frame, track_frame);
  TrackingResult out = tracker.finish();
  const std::vector<std::string> notes = skipped.notes(source.size());
  out.notes.insert(out.notes.begin(), notes.begin(), notes.end());
  out.skipped = skipped.count();
  return out;
}

DetectedLoops find_loops(const TrackingResult& tracked,
                         const RgbdSource& source,
                         const FrontendOptions& options,
                         const FrontendProgress& progress) {
  return detect_loops(
      tracked, source.camera(), options.loops, [&](std::size_t done, std::size_t all) {
        if (progress) progress("loops", done, all);
      });
}

/// Refines odometry and closures by depth and updates keyframes and frames. Returns the factor by
/// which the differences between feature-based and depth-based edges exceed their stated
/// uncertainty.
double refine(TrackingResult& tracked,
              DetectedLoops& loops,
              const RgbdSource& source,
              const FrontendOptions& options,
              const FrontendProgress& progress) {
  RefinedEdges edges = refine_by_depth(source,
                                       tracked,
                                       loops.closures,
                                       options.features.depth_max,
                                       [&](std::size_t done, std::size_t all) {
                                         if (progress) progress("depth", done, all);
                                       });
  tracked.notes.push_back(fmt::format("measured again by depth: {} of {} steps, {} of {} loops",
                                      edges.odometry_refined,
                                      edges.odometry.size(),
                                      edges.closures_refined,
                                      edges.closures.size()));
  const double excess =
      information_excess(repeated_measurement_gaps(tracked.odometry, edges.odometry));
  update_poses(tracked, edges.odometry);
  loops.closures = std::move(edges.closures);
  return excess;
}

/// Divides all information matrices by the factor by which loops disagree with odometry, or depth
/// with features, more than expected. Information is never increased, because errors common to both
/// cannot be detected.
void scale_information(TrackingResult& tracked, DetectedLoops& loops, double depth_excess) {
  const double loop_excess = information_excess(normalised_gaps(tracked.odometry, loops.closures));
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
                      const FrontendProgress& progress) {
  run_opencv_on_one_thread();
  TrackingResult tracked = track(source, options, progress);
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
  DetectedLoops loops = find_loops(tracked, source, options, progress);
  double depth_excess = 1.0;
  if (options.refine_depth) depth_excess = refine(tracked, loops, source, options, progress);
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
