/// Do reference and estimate follow the same body? A marker, an IMU or another camera beside it
/// leaves an error in every score that no correction can take away.
#pragma once

#include <optional>

#include "metrics/alignment/hand_eye/hand_eye.hpp"
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
  HandEye fit;
  std::size_t stretches = 0;
};

/// `reference` and `estimate` are pairs. Nothing with fewer than 20 turning stretches. O(n).
std::optional<BodyOffset> body_offset(const Trajectory& reference,
                                      const Trajectory& estimate,
                                      const BodyOffsetOptions& options);

/// Of an evaluation's pairs; nothing either where a list holds positions only or the protocol has
/// projected them.
std::optional<BodyOffset> body_offset(const Evaluation& evaluation,
                                      const BodyOffsetOptions& options);

/// A sentence when axes or place explain at least half of the differences, else empty. `stated` is
/// where the reference's body was already taken to be; the place told, x,y,z [m] and when turned
/// qx,qy,qz,qw, is to stand in its stead. Smaller offsets that matter can stay unsaid: on KITTI
/// below half a metre to a metre, hand-held below ten to twenty centimetres.
std::string other_body(const BodyOffset& offset, const Pose& stated);

/// The offset as numbers: position x, y, z and its deviation x, y, z [m], attitude x, y, z, w [1],
/// turn [deg], turn_explained and position_explained [%], stretches. Throws Undefined where there
/// is none.
std::vector<Score> body_offset_scores(const Evaluation& evaluation,
                                      const BodyOffsetOptions& options);

}  // namespace loopbench
