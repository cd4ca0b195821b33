/// The space that a sensor sees, and how much of it two poses share.
#pragma once

#include <vector>

#include "datasets/core/se3.hpp"

namespace loopbench {

/// A part of a spherical shell around the sensor, in the axes of the body.
struct View {
  enum class Axes {
    z_forward,  ///< of cameras: x right, y down
    x_forward   ///< of vehicles: y left, z up
  };
  double horizontal = 1.0;  ///< field of view about the vertical axis, at most 2 pi [rad]
  double vertical = 0.75;   ///< at most pi [rad]
  double nearest = 0.0;     ///< range [m]
  double farthest = 4.0;    ///< > nearest [m]
  double share = 0.5;       ///< of the volume, that a revisit sees again [-]
  Axes axes = Axes::z_forward;
};

/// Part of the volume of one view that another one contains, by points of equal volume. The same in
/// both directions, but for the choice of the points. Nothing hides anything.
class SharedView {
 public:
  explicit SharedView(const View& view);

  /// Whether the view from `to` contains at least `share` of that from `from`. O(1).
  bool is_seen_again(const Pose& to_from_from) const;

  /// The part itself [-]. O(1).
  double share(const Pose& to_from_from) const;

 private:
  bool contains(const Vector3& point) const;

  View view_;
  double sine_;                  ///< of half of the vertical field of view
  std::vector<Vector3> points_;  ///< in the body
};

}  // namespace loopbench
