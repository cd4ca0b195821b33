#include "datasets/images/dense/refine_by_depth.hpp"

#include <algorithm>

#include "datasets/core/interpolate.hpp"
#include "datasets/images/dense/surface.hpp"
#include "datasets/images/frames/ordered_pipeline.hpp"

namespace loopbench::rgbd {
namespace {

constexpr int kSurfaceWidth = 160;        // [px]
constexpr std::size_t kWindow = 5;        // previous keyframes that a new one is aligned with
constexpr double kMinOverlap = 0.2;       // share of a surface that the others show, too [-]
constexpr double kMaxTranslation = 0.15;  // correction of an edge [m]
constexpr double kMaxRotation = 0.15;     // correction of an edge [rad]
constexpr double kGuessedVariance = 0.1;  // largest variance of a measured edge [m^2], [rad^2]
constexpr std::size_t kClosureReach = 1;  // keyframes on each side of the older keyframe

/// Whether an edge was not measured but connects two maps after a tracking loss.
bool is_guess(const Edge& edge) {
  return edge.information.diagonal().minCoeff() < 1.0 / kGuessedVariance;
}

bool is_accepted(const SurfaceAlignment& found, const Pose& prior) {
  const Pose moved = prior.inverse() * found.world_from_camera;
  return is_finite(found.world_from_camera) && found.share >= kMinOverlap &&
         moved.translation.norm() < kMaxTranslation &&
         log_so3(moved.rotation).norm() < kMaxRotation;
}

/// Reads downsampled depth images of all keyframes; empty for images that cannot be read.
std::vector<DownsampledDepth> keyframe_depths(const RgbdSource& source,
                                              const std::vector<Keyframe>& keyframes,
                                              double depth_max) {
  const Camera camera = source.camera();
  const auto read = [&](std::size_t k) {
    std::string why;
    const auto images = source.read(keyframes[k].frame, why);
    return images ? downsample_depth(images->depth, camera, kSurfaceWidth, depth_max)
                  : DownsampledDepth();
  };
  std::vector<DownsampledDepth> out;
  ordered_pipeline<DownsampledDepth>(
      keyframes.size(),
      hardware_threads(),
      4 * hardware_threads(),
      read,
      [&](std::size_t, DownsampledDepth depth) { out.push_back(std::move(depth)); });
  return out;
}

/// Aligns every keyframe with the previous ones. Returns the keyframe poses in the frame of the
/// first keyframe and writes the refined edges to `out`.
std::vector<Pose> refine_odometry(const std::vector<DownsampledDepth>& depths,
                                  const std::function<void(std::size_t)>& progress,
                                  RefinedEdges& out) {
  std::vector<Pose> world_from_keyframe{Pose{Rotation::Identity(), Vector3::Zero()}};
  std::vector<Surface> surfaces;  // of the last keyframes, oldest first
  surfaces.push_back(surface_of(depths.front()));
  for (std::size_t k = 1; k < depths.size(); ++k) {
    progress(k);
    Edge& edge = out.odometry[k - 1];
    const Pose& last = world_from_keyframe.back();
    const PriorPose prior{normalized(last * edge.from_from_to), edge.information};
    Surface surface = surface_of(depths[k]);
    std::vector<PlacedSurface> model;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      model.push_back({&surfaces[i], world_from_keyframe[k - surfaces.size() + i]});
    }
    const SurfaceAlignment found = align_surface(surface, model, prior);
    Pose here = prior.world_from_camera;
    if (!is_guess(edge) && is_accepted(found, here)) {
      here = found.world_from_camera;
      edge.from_from_to = normalized(last.inverse() * here);
      edge.information = found.information;
      ++out.odometry_refined;
      if (surfaces.size() == kWindow) surfaces.erase(surfaces.begin());
    } else {
      surfaces.clear();
    }
    surfaces.push_back(std::move(surface));
    world_from_keyframe.push_back(here);
  }
  return world_from_keyframe;
}

struct RefinedClosure {
  Edge edge;
  bool refined = false;
};

RefinedClosure refine_closure(const Edge& closure,
                              const std::vector<DownsampledDepth>& depths,
                              const std::vector<Pose>& world_from_keyframe) {
  RefinedClosure out{closure};
  const std::size_t first = closure.from - std::min(closure.from, kClosureReach);
  const std::size_t last = std::min(closure.from + kClosureReach, closure.to - 1);
  std::vector<Surface> surfaces;
  for (std::size_t k = first; k <= last; ++k) surfaces.push_back(surface_of(depths[k]));
  std::vector<PlacedSurface> model;
  const Pose from_from_world = world_from_keyframe[closure.from].inverse();
  for (std::size_t k = first; k <= last; ++k) {
    model.push_back({&surfaces[k - first], from_from_world * world_from_keyframe[k]});
  }
  const PriorPose prior{closure.from_from_to, closure.information};
  const SurfaceAlignment found = align_surface(surface_of(depths[closure.to]), model, prior);
  out.refined = is_accepted(found, closure.from_from_to);
  if (out.refined) {
    out.edge.from_from_to = found.world_from_camera;
    out.edge.information = found.information;
  }
  return out;
}

}  // namespace

RefinedEdges refine_by_depth(const RgbdSource& source,
                             const TrackingResult& tracked,
                             const std::vector<Edge>& closures,
                             double depth_max,
                             const std::function<void(std::size_t, std::size_t)>& progress) {
  RefinedEdges out{tracked.odometry};
  const std::size_t steps = tracked.keyframes.size() + closures.size();
  const auto depths = keyframe_depths(source, tracked.keyframes, depth_max);
  const std::vector<Pose> poses = refine_odometry(
      depths, [&](std::size_t k) { progress(k + 1, steps); }, out);
  const auto refine = [&](std::size_t i) { return refine_closure(closures[i], depths, poses); };
  ordered_pipeline<RefinedClosure>(closures.size(),
                                   hardware_threads(),
                                   4 * hardware_threads(),
                                   refine,
                                   [&](std::size_t i, RefinedClosure one) {
                                     progress(tracked.keyframes.size() + i + 1, steps);
                                     out.closures_refined += one.refined ? 1 : 0;
                                     out.closures.push_back(std::move(one.edge));
                                   });
  return out;
}

void update_poses(TrackingResult& tracked, const std::vector<Edge>& odometry) {
  std::vector<Pose> before;
  for (const Keyframe& keyframe : tracked.keyframes) before.push_back(keyframe.world_from_camera);
  for (std::size_t k = 1; k < tracked.keyframes.size(); ++k) {
    tracked.keyframes[k].world_from_camera =
        normalized(tracked.keyframes[k - 1].world_from_camera * odometry[k - 1].from_from_to);
  }
  tracked.odometry = odometry;
  std::size_t k = 0;  // last keyframe before the frame
  for (StampedPose& frame : tracked.frames) {
    while (k + 2 < before.size() && tracked.keyframes[k + 1].stamp < frame.stamp) ++k;
    const auto moved_with = [&](std::size_t keyframe) {
      return tracked.keyframes[keyframe].world_from_camera * before[keyframe].inverse() *
             frame.world_from_body;
    };
    const double begin = tracked.keyframes[k].stamp;
    const double u = (frame.stamp - begin) / (tracked.keyframes[k + 1].stamp - begin);
    frame.world_from_body =
        normalized(interpolate(moved_with(k), moved_with(k + 1), std::clamp(u, 0.0, 1.0)));
  }
}

}  // namespace loopbench::rgbd
