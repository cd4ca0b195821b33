/// Loop closures measured in another trajectory of the same sequence (the reference or another run)
/// or stated in a text file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/derive/poses_at.hpp"
#include "datasets/derive/revisits.hpp"
#include "datasets/noise/noise_stream.hpp"

namespace loopbench {

struct ClosureNoise {
  double sigma_t = 0.02;  ///< [m]
  double sigma_r = 0.01;  ///< [rad]
};

/// Returns a closure for every revisit of `run` at keyframe stamps: the relative pose of the run
/// between the two keyframes, with information from `noise`. At most `max` closures, subsampled
/// evenly; 0 returns all. Both trajectories must contain poses of the same body; no extrinsic
/// offset is applied. Sorted by (to, from). O(n + revisits * max).
std::vector<Edge> measure_closures_in_run(const Trajectory& keyframes,
                                          const Trajectory& run,
                                          const RevisitRule& rule,
                                          std::size_t max,
                                          const InterpolationLimits& reach,
                                          const ClosureNoise& noise);

/// Adds noise to edges: measured = true * exp(e), e ~ N(0, diag(sigma_t^2, sigma_r^2)), drawn in
/// the order of the edges. With a `normal` in the axes of the body, e keeps its plane.
std::vector<Edge> with_noise(std::vector<Edge> edges,
                             const ClosureNoise& noise,
                             const NoiseStream& stream,
                             const std::optional<Vector3>& normal = {});

/// Ratio of the path lengths of `run` and `keyframes` over their common stamps; 1 if there are
/// fewer than two. Runs with different scales (monocular) have a ratio far from 1.
double path_length_ratio(const Trajectory& keyframes,
                         const Trajectory& run,
                         const InterpolationLimits& reach);

/// Of closures that state no scale [-]: a deviation of its logarithm of 1000.
inline constexpr double kNoScaleInformation = 1e-6;

/// Converts closures measured in `run` to Sim(3), for an estimate with scale drift (monocular). The
/// scale at a keyframe is the path-length ratio of run and estimate over ten common keyframes on
/// either side. Where the path between them is not longer than the noise of the positions (a
/// similarity has another scale, or one whose 95 % interval is wider than 20 %), it is that of a
/// similarity over 20 to 160 keyframes. Each edge gets the scale of `to` relative to `from`, and
/// its translation is converted to the scale of `from`. If no window shows a scale, the edge states
/// none (scale 1, kNoScaleInformation). Throws InputError if one of the two trajectories does not
/// move there. O(n + edges).
std::vector<Edge> with_local_scale(std::vector<Edge> edges,
                                   const Trajectory& keyframes,
                                   const Trajectory& run,
                                   const InterpolationLimits& reach);

/// Number of edges with kNoScaleInformation.
std::size_t count_without_scale(const std::vector<Edge>& edges);

/// A closure between the first and the last of at least two poses, at the same position up to
/// `sigma_t` [m], for a body that returned to its start with an unknown rotation. The rotation is
/// that of the poses, so that spreading rules do not change it, with a standard deviation of 10
/// rad, so that least squares ignore it.
Edge start_equals_end(const Trajectory& poses, double sigma_t);

/// Sorts closures by (to, from), as required by Problem; equal ones keep their order. `marked` are
/// indices of closures, which follow them and are ascending afterwards. O(n log n).
void sort_closures(std::vector<Edge>& closures, std::vector<std::size_t>* marked = nullptr);

struct StampedClosure {
  double stamp_from = 0.0;  ///< [s]
  double stamp_to = 0.0;    ///< [s]
  Pose from_from_to;
  ClosureNoise noise;
  std::size_t line = 0;  ///< line number in the file
  /// The measured bodies in the frames of the poses at the stamps, see move_to_poses().
  Pose pose_from_measured_from = {}, pose_from_measured_to = {};
};

/// Reads one closure per line: `stamp_from stamp_to tx ty tz qx qy qz qw [sigma_t sigma_r]` in [s],
/// [m], [rad]. The pose is that of the body at stamp_to in the frame of the body at stamp_from;
/// either stamp may be the later one. Lines that start with `#` are comments. Lines without sigmas
/// use `noise`. Throws InputError `file:line: what`. O(size of the file).
std::vector<StampedClosure> read_closure_file(const std::filesystem::path& file,
                                              const ClosureNoise& noise);

/// Moves ends that are between two poses to the nearest pose in time, by the motion of `run` (all
/// tracked poses) between the two times, where `reach` allows its interpolation. The stamps become
/// those of the poses. The error of that motion is not added to the noise. Returns the number of
/// closures that were moved. O(closures log poses).
std::size_t move_to_poses(std::vector<StampedClosure>& closures,
                          const Trajectory& poses,
                          const Trajectory& run,
                          const InterpolationLimits& reach);

/// Converts closures to edges between the nearest poses in time, at most `max_diff` [s] away. Edges
/// have from < to and are sorted by (to, from). Throws InputError `file:line: what` if there is no
/// such pose or if both stamps match the same pose.
std::vector<Edge> as_edges(const std::vector<StampedClosure>& closures,
                           const Trajectory& poses,
                           double max_diff,
                           const std::filesystem::path& file);

/// Reads the closures of a g2o graph whose vertices are the `poses`: in the order of their ids if
/// there are as many, otherwise pose k has id k. Edges between neighbouring poses are odometry and
/// left out. from < to, sorted by (to, from). Throws InputError. O(size of the file).
std::vector<Edge> read_graph_closures(const std::filesystem::path& file, const Trajectory& poses);

}  // namespace loopbench
