/// A reference that follows another body than the estimate: a marker, an IMU, another camera.
#pragma once

#include "datasets/core/fields.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// body_from_reference: where the reference's body sits in the estimate's, in the order of TUM's
/// files. All zero, and one: the same body.
struct ReferenceBody {
  double x = 0.0;  ///< [m]
  double y = 0.0;
  double z = 0.0;
  double qx = 0.0;
  double qy = 0.0;
  double qz = 0.0;
  double qw = 1.0;
};

template <class Visit>
void reference_body_fields(ReferenceBody& o, Visit visit) {
  const Between unit{-1.0, 1.0};
  visit(
      "reference_body.x", o.x, "of the reference's body in the estimate's [m]", Between{-1e6, 1e6});
  visit("reference_body.y", o.y, "likewise [m]", Between{-1e6, 1e6});
  visit("reference_body.z", o.z, "likewise [m]", Between{-1e6, 1e6});
  visit("reference_body.qx", o.qx, "how it is turned there: a unit quaternion [-]", unit);
  visit("reference_body.qy", o.qy, "likewise [-]", unit);
  visit("reference_body.qz", o.qz, "likewise [-]", unit);
  visit("reference_body.qw", o.qw, "likewise [-]", unit);
}

/// body_from_reference. Throws OptionError when the quaternion is off unit by more than 0.01.
Pose pose_of(const ReferenceBody& body);

/// Not at the estimate's body itself.
bool is_elsewhere(const ReferenceBody& body);

/// The reference as the estimate's body would have gone, world_from_reference *
/// body_from_reference^-1; to the bit what it was when they are the same body. Throws as pose_of.
/// O(n).
Trajectory of_estimate_body(Trajectory reference, const ReferenceBody& body);

}  // namespace loopbench
