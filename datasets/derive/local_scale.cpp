#include <algorithm>
#include <cmath>
#include <optional>

#include "datasets/core/align_points.hpp"
#include "datasets/derive/closures.hpp"
#include "datasets/derive/run_at_keyframes.hpp"

namespace loopbench {
namespace {

/// Positions of the estimate and of the other run at the same keyframes.
struct Positions {
  Eigen::Matrix3Xd estimate, run;

  Positions(const Trajectory& keyframes, const RunAtKeyframes& shared)
      : estimate(3, shared.run.size()), run(3, shared.run.size()) {
    for (std::size_t k = 0; k < shared.run.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      estimate.col(column) = keyframes[shared.keyframe[k]].world_from_body.translation;
      run.col(column) = shared.run[k].world_from_body.translation;
    }
  }
};

double length_of(const Eigen::Matrix3Xd& path) {
  const Eigen::Index steps = path.cols() - 1;
  return (path.rightCols(steps) - path.leftCols(steps)).colwise().norm().sum();
}

/// Scales of the run over the estimate around a keyframe.
struct LocalScale {
  double by_length = 0.0;   ///< ratio of path lengths; noise of positions lengthens paths
  double by_shape = 0.0;    ///< of a similarity; 0: none
  double deviation = 0.0;   ///< of the logarithm of `by_shape` [-]
  bool has_motion = false;  ///< in both runs

  /// Whether 95 % of the scale, and of the ratio of two such scales, are within 20 %.
  bool is_known() const {
    constexpr double kHalf = 0.1, kOfTwo = 0.7071, kOfDeviation = 1.96;
    return has_motion && by_shape > 0.0 && kOfDeviation * deviation <= kOfTwo * kHalf &&
           std::abs(std::log(by_length / by_shape)) <= kHalf;
  }
};

LocalScale scale_between(const Positions& all, Eigen::Index first, Eigen::Index last) {
  // Errors of neighbouring positions are alike: one in five counts.
  constexpr double kOfNeighbours = 5.0;
  const Eigen::Index count = last - first + 1;
  const Eigen::Matrix3Xd from = all.estimate.middleCols(first, count);
  const Eigen::Matrix3Xd to = all.run.middleCols(first, count);
  LocalScale out;
  const double length = length_of(from), other_length = length_of(to);
  out.has_motion = length > 0.0 && other_length > 0.0;
  if (!out.has_motion) return out;
  out.by_length = other_length / length;
  if (count < 4) return out;
  const Eigen::Matrix4d motion = align_points(from, to, true);
  const double determinant = motion.topLeftCorner<3, 3>().determinant();
  if (!(determinant > 0.0)) return out;
  out.by_shape = std::cbrt(determinant);
  const Eigen::Matrix3Xd moved =
      (motion.topLeftCorner<3, 3>() * from).colwise() + motion.topRightCorner<3, 1>();
  const Vector3 mean = from.rowwise().mean();
  const double spread = (from.colwise() - mean).squaredNorm();
  const double variance = (moved - to).squaredNorm() / static_cast<double>(3 * count - 7);
  out.deviation = std::sqrt(kOfNeighbours * variance / spread) / out.by_shape;
  return out;
}

struct Found {
  double scale = 1.0;
  bool is_known = false;
};

/// The scale over ten keyframes on either side, or over more if it is not known from these.
/// nullopt: one of the two does not move.
std::optional<Found> scale_around(const Positions& all, Eigen::Index at) {
  // [keyframes]; scale drifts slowly, while the length of a single step is noisy
  constexpr Eigen::Index kHalfWindow = 10, kWidest = 160;
  const Eigen::Index end = all.run.cols() - 1;
  std::optional<Found> out;
  for (Eigen::Index half = kHalfWindow; half <= kWidest; half *= 2) {
    const Eigen::Index first = std::max<Eigen::Index>(0, at - half),
                       last = std::min(at + half, end);
    const LocalScale found = scale_between(all, first, last);
    if (found.is_known())
      return Found{half == kHalfWindow ? found.by_length : found.by_shape, true};
    if (found.has_motion) {
      out = Found{found.by_shape > 0.0 ? found.by_shape : found.by_length, false};
    }
    if (first == 0 && last == end) break;
  }
  return out;
}

}  // namespace

std::vector<Edge> with_local_scale(std::vector<Edge> edges,
                                   const Trajectory& keyframes,
                                   const Trajectory& run,
                                   const InterpolationLimits& reach) {
  const RunAtKeyframes shared = at_keyframes(keyframes, run, reach);
  const Positions positions(keyframes, shared);
  const auto scale_at = [&](std::size_t keyframe) {
    const auto found = std::ranges::lower_bound(shared.keyframe, keyframe);
    const std::optional<Found> scale = scale_around(positions, found - shared.keyframe.begin());
    if (scale) return *scale;
    throw InputError(
        "keyframe at " + to_text(keyframes[keyframe].stamp) +
        " s: found no motion around it, expected motion in both runs to compare their scales");
  };
  for (Edge& edge : edges) {
    const Found from = scale_at(edge.from), to = scale_at(edge.to);
    edge.from_from_to.translation /= from.scale;
    if (from.is_known && to.is_known) {
      edge.scale = to.scale / from.scale;
    } else {
      edge.scale_information = kNoScaleInformation;
    }
  }
  return edges;
}

std::size_t count_without_scale(const std::vector<Edge>& edges) {
  return static_cast<std::size_t>(
      std::ranges::count(edges, kNoScaleInformation, &Edge::scale_information));
}

}  // namespace loopbench
