#include "metrics/pairing/nearest_position.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/parallel.hpp"
#include "datasets/core/params.hpp"
#include "metrics/alignment/alignment.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kBlockOfPieces = 32;
constexpr std::size_t kNoPiece = std::numeric_limits<std::size_t>::max();

const Vector3& position(const Trajectory& poses, std::size_t i) {
  return poses[i].world_from_body.translation;
}

/// Displacement from about `length` / 2 before to about `length` / 2 after each pose [m]. O(n).
std::vector<Vector3> directions(const Trajectory& poses, double length) {
  std::vector<Vector3> out;
  const auto is_near = [&](std::size_t i, std::size_t k) {
    return (position(poses, i) - position(poses, k)).norm() < 0.5 * length;
  };
  std::size_t before = 0, after = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    while (before < i && !is_near(i, before + 1)) ++before;
    after = std::max(after, i);
    while (after + 1 < poses.size() && is_near(i, after)) ++after;
    out.push_back(position(poses, after) - position(poses, before));
  }
  return out;
}

/// Point of a path: between the poses `piece` and `piece` + 1.
struct PathPoint {
  std::size_t piece = kNoPiece;  ///< kNoPiece: no point is near
  double share = 0.0;            ///< of the piece, 0..1
};

/// Finds the nearest points of a path.
class PathPieces {
 public:
  PathPieces(const Trajectory& poses, double farthest)
      : poses_(poses), directions_(directions(poses, farthest)), farthest_(farthest) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (i % kBlockOfPieces == 0) boxes_.emplace_back();
      boxes_.back().extend(position(poses, i)).extend(position(poses, next(i)));
    }
  }

  PathPoint nearest(const Vector3& point, const Vector3& direction) const {
    PathPoint out;
    double least = farthest_ * farthest_;
    for (std::size_t block = 0; block < boxes_.size(); ++block) {
      if (boxes_[block].squaredExteriorDistance(point) > least) continue;
      const std::size_t begin = block * kBlockOfPieces;
      for (std::size_t i = begin; i < std::min(begin + kBlockOfPieces, poses_.size()); ++i) {
        if (directions_[i].dot(direction) < 0.0) continue;
        const Vector3 along = position(poses_, next(i)) - position(poses_, i);
        const Vector3 there = point - position(poses_, i);
        const double length = along.squaredNorm();
        const double share = length > 0.0 ? std::clamp(there.dot(along) / length, 0.0, 1.0) : 0.0;
        const double distance = (there - share * along).squaredNorm();
        if (distance > least || (distance == least && out.piece != kNoPiece)) continue;
        least = distance;
        out = {i, share};
      }
    }
    return out;
  }

  Pose at(const PathPoint& point) const {
    const Pose& start = poses_[point.piece].world_from_body;
    if (point.share == 0.0) return start;
    return interpolate(start, poses_[next(point.piece)].world_from_body, point.share);
  }

 private:
  /// The last pose is a piece of its own.
  std::size_t next(std::size_t i) const { return std::min(i + 1, poses_.size() - 1); }

  const Trajectory& poses_;
  std::vector<Vector3> directions_;
  double farthest_;
  std::vector<Eigen::AlignedBox3d> boxes_;
};

std::vector<PathPoint> nearest_points(const PathPieces& path,
                                      const Trajectory& poses,
                                      double farthest) {
  std::vector<PathPoint> out(poses.size());
  const std::vector<Vector3> headings = directions(poses, farthest);
  parallel_for_blocks(poses.size(), [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) out[i] = path.nearest(position(poses, i), headings[i]);
  });
  return out;
}

}  // namespace

RepeatedRoute on_repeated_route(const Trajectory& reference,
                                const Trajectory& estimate,
                                double farthest,
                                Align how) {
  constexpr int kRounds = 200;
  constexpr double kUnmoved = 1e-6;  // of `farthest`
  const PathPieces path(reference, farthest);
  Trajectory aligned = estimate;
  RepeatedRoute out;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<PathPoint> points = nearest_points(path, aligned, farthest);
    out.reference.clear();
    Trajectory paired;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].piece == kNoPiece) continue;
      out.reference.push_back({estimate[i].stamp, path.at(points[i])});
      paired.push_back(estimate[i]);
    }
    if (paired.empty()) {
      throw std::runtime_error("no pose of the estimate is within " + to_text(farthest) +
                               " m of the reference's path in the same direction: both files must "
                               "be in one frame");
    }
    if (how == Align::none) break;
    const Trajectory last = aligned;
    aligned = moved(align(out.reference, paired, how), estimate);
    double largest = 0.0;
    for (std::size_t i = 0; i < last.size(); ++i) {
      largest = std::max(largest, (position(aligned, i) - position(last, i)).norm());
    }
    if (largest <= kUnmoved * farthest) break;
  }
  std::size_t visited = 0;
  for (const PathPoint& point :
       nearest_points(PathPieces(aligned, farthest), reference, farthest)) {
    visited += point.piece != kNoPiece;
  }
  out.visited = static_cast<double>(visited) / static_cast<double>(reference.size());
  return out;
}

}  // namespace loopbench::metrics
