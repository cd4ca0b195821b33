/// Do reference and estimate follow the same body? A marker, an IMU or another camera beside it
/// leaves an error in every score that no correction can take away.
#pragma once

#include <optional>

#include "metrics/metric.hpp"

namespace loopbench {

struct BodyOffsetOptions {
  double turn = 6.0;      ///< of a stretch of the way that is looked at [deg]
  double longest = 10.0;  ///< such stretch: later odometry has drifted [s]
};

template <class Visit>
void fields(BodyOffsetOptions& o, Visit visit) {
  visit("turn", o.turn, "of a stretch of the way that is looked at [deg]", Between{0.1, 90.0});
  visit("longest", o.longest, "such stretch: later odometry has drifted [s]", Above{0.0});
}

struct BodyOffset {
  Pose body_from_reference;             ///< where the reference's body sits in the estimate's
  Vector3 deviation = Vector3::Zero();  ///< standard deviations of its translation [m]
  double explained = 0.0;  ///< part of the squared differences in position; below 0: none [-]
  std::size_t stretches = 0;
};

/// Hand and eye: over stretches that turn, reference Q and estimate Z of one body with offset C
/// move by Z C = C Q. Its rotation turns the reference's motions into the estimate's in least
/// squares (Kabsch, of rotation vectors, and of displacements where all turn about one axis), and
/// is left out below 5 degrees or where it does not explain half of how they differ. Its
/// translation c solves (R_Z - I) c = R_C t_Q - t_Z with Huber's weights, about the means of both
/// sides: where all turn one way, steady drift looks like another place. Directions that turning
/// hardly tells (along a vehicle's only axis) stay zero.
///
/// `reference` and `estimate` are pairs. Nothing with fewer than 20 stretches. O(n).
/// Source: F. Park, B. Martin, Robot sensor calibration: solving AX = XB on the Euclidean group,
/// IEEE T-RO 1994.
std::optional<BodyOffset> body_offset(const Trajectory& reference,
                                      const Trajectory& estimate,
                                      const BodyOffsetOptions& options);

/// Of an evaluation's pairs; nothing either where a list holds positions only or the protocol has
/// projected them.
std::optional<BodyOffset> body_offset(const Evaluation& evaluation,
                                      const BodyOffsetOptions& options);

/// A sentence when the offset explains at least half of the differences, the mean's too, else
/// empty. The place is x,y,z [m] and, when turned, qx,qy,qz,qw. Of 31 real runs that follow their
/// reference's camera (TUM, KITTI) it accuses none.
std::string other_body(const BodyOffset& offset);

/// The offset as numbers: x, y, z [m], turn [deg], explained [%]. Throws Undefined where there is
/// none.
std::vector<Score> body_offset_scores(const Evaluation& evaluation,
                                      const BodyOffsetOptions& options);

}  // namespace loopbench
