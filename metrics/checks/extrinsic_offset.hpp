/// Detects whether reference and estimate track different bodies. A marker, an IMU or another
/// camera with an offset adds an error to every score that no correction can remove.
#pragma once

#include <optional>

#include "metrics/alignment/hand_eye.hpp"
#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct ExtrinsicOffsetOptions {
  double rotation = 6.0;  ///< rotation angle over which relative poses are compared [deg]
  double longest = 10.0;  ///< longest duration of such a relative pose; odometry drifts [s]
};

template <class Visit>
void fields(ExtrinsicOffsetOptions& o, Visit visit) {
  visit("rotation",
        o.rotation,
        "rotation angle over which relative poses are compared [deg]",
        Between{0.1, 90.0});
  visit("longest", o.longest, "longest duration of a compared relative pose [s]", GreaterThan{0.0});
}

struct ExtrinsicOffset {
  HandEye fit;
  std::size_t relative_poses = 0;
};

/// Estimates the offset from paired poses. nullopt with fewer than 20 relative poses. O(n).
std::optional<ExtrinsicOffset> extrinsic_offset(const Trajectory& reference,
                                                const Trajectory& estimate,
                                                const ExtrinsicOffsetOptions& options);

/// The same for the pairs of an evaluation. Also nullopt if a list holds only positions or the
/// protocol has projected the trajectories.
std::optional<ExtrinsicOffset> extrinsic_offset(const Evaluation& evaluation,
                                                const ExtrinsicOffsetOptions& options);

/// "x,y,z" [m] and, if rotated, ",qx,qy,qz,qw": value of the option `--ref-body`.
std::string body_option(const Pose& body_from_reference);

/// Returns a warning if rotation or lever arm explain at least half of the differences, otherwise
/// an empty string. `stated` is the offset that was already applied to the reference; the message
/// gives the offset that should replace it: x,y,z [m] and, if rotated, qx,qy,qz,qw. Relevant
/// offsets can go undetected if they are small: below 0.5 to 1 m on KITTI, below 0.1 to 0.2 m for
/// hand-held cameras.
std::string other_body(const ExtrinsicOffset& offset, const Pose& stated);

/// The offset as scores: position x, y, z and its standard deviation x, y, z [m], quaternion x, y,
/// z, w [1], rotation [deg], rotation_explained and lever_arm_explained [%], number of relative
/// poses. Throws Undefined if no offset can be estimated.
std::vector<Score> extrinsic_offset_scores(const Evaluation& evaluation,
                                           const ExtrinsicOffsetOptions& options);

}  // namespace loopbench::metrics
