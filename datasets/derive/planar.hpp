/// Decides whether a problem is planar: poses in SE(2) instead of SE(3).
#pragma once

#include <string>
#include <vector>

#include "datasets/core/plane.hpp"
#include "datasets/core/rotation_between.hpp"
#include "datasets/core/sequence.hpp"

namespace loopbench {

template <class Visit>
void planar_field(Planar& planar, Visit visit) {
  visit("planar",
        planar,
        "poses in SE(2) instead of SE(3); auto: if all poses and closures are in one plane within "
        "rounding; yes: moved to it");
}

/// Poses and measurements of one sequence; lists that do not exist are empty.
struct PlanarParts {
  struct Poses {
    std::string name;  ///< for the note: "reference"
    Trajectory* poses;
  };
  std::vector<Poses> trajectories;  ///< the estimate first
  std::vector<Pose*> measurements;  ///< relative poses: closures, odometry
};

struct PlanarChoice {
  bool planar = false;
  /// Normal in the axes of the body; Problem::planar requires z, see with_body().
  Vector3 normal = Vector3::UnitZ();
  std::string note;  ///< what was chosen and why; empty: nothing is planar

  /// Rotation of the body that makes the normal its z axis.
  Rotation body_from_plane() const { return rotation_between(Vector3::UnitZ(), normal); }
};

/// `automatic`: planar if all parts are in planes with one normal in the body, within rounding.
/// `yes`: moves all parts to the plane of the estimate's most constant axis. O(size of the parts).
PlanarChoice choose_planar(Planar wanted, const PlanarParts& parts);

/// Expresses all poses, edges and anchors by a body whose pose in the old one is `body_from_new`.
/// The identity changes no bit.
void change_body(Problem& problem, const Rotation& body_from_new);

/// Likewise; positions without rotation remain.
void change_body(Trajectory& poses, const Rotation& body_from_new);

/// Likewise for problem and reference, stated in the provenance.
void set_body(Sequence& sequence, const Rotation& body_from_new);

}  // namespace loopbench
