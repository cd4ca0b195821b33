/// Anchors from a file of measured positions.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "datasets/derive/poses_at.hpp"

namespace loopbench {

/// A measured position in the world frame of its file.
struct StampedPosition {
  double stamp = 0.0;  ///< [s]
  Vector3 position = Vector3::Zero();
  Matrix3 covariance = Matrix3::Identity();
};

struct AnchorFile {
  std::vector<StampedPosition> positions;  ///< ascending stamps
  std::string note;  ///< origin of the local frame of latitude, longitude and height; may be empty
};

/// Reads rows `stamp x y z`, `stamp x y z sigma`, or `stamp x y z` and the upper triangle of the
/// covariance (xx xy xz yy yz zz), in [s], [m], [m^2], or any format of read_trajectory() with
/// positions. Rows without sigma or covariance have standard deviation `sigma`. Throws InputError.
/// O(size of the file).
AnchorFile read_anchor_file(const std::filesystem::path& file, double sigma);

/// Converts positions to anchors at the nearest keyframe in time. Between keyframes, the anchor's
/// point in the frame of the keyframe is the position of the body that `run`, all tracked poses
/// including keyframes, has at the stamp. Positions before the first and after the last pose, and
/// in gaps beyond `reach`, are skipped and counted in `skipped`. O((poses + positions) log
/// keyframes).
std::vector<Anchor> as_anchors(const std::vector<StampedPosition>& positions,
                               const Trajectory& keyframes,
                               const Trajectory& run,
                               const InterpolationLimits& reach,
                               std::size_t& skipped);

/// Sets the anchors of the sequence's problem from those positions of the file that are between two
/// poses of `run` at most `max_gap` apart [s], and adds notes on the file and on those skipped.
/// Throws InputError with `name` if all are skipped.
void add_anchors(const AnchorFile& file,
                 const std::string& name,
                 const Trajectory& run,
                 double max_gap,
                 Sequence& sequence);

}  // namespace loopbench
