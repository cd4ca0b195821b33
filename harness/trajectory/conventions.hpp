/// Corrections of conventions in which a file differs from what its reader expects.
#pragma once

#include <string>

#include "datasets/formats/trajectory_file.hpp"

namespace loopbench::harness {

struct Conventions {
  std::string
      quaternion_order;       ///< actual order: wxyz | xyzw, if read in the other; empty: as read
  bool conjugate = false;     ///< invert rotations, not positions
  std::string axes;           ///< source axis of x, y, z of the positions, "-y,x,z"; empty: as read
  double scale = 1.0;         ///< factor of the positions
  double stamp_scale = 1.0;   ///< factor of the stamps
  bool invert_poses = false;  ///< body_from_world -> world_from_body

  bool any() const;
};

/// Applies all corrections in the order of their declaration. Covariances are removed; exact stamps
/// too, if stamps are scaled. Throws InputError for an invalid order, list of axes or factor. O(n).
TrajectoryFile corrected(TrajectoryFile file, const Conventions& conventions);

}  // namespace loopbench::harness
