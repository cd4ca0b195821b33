#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/core/mirrored.hpp"
#include "metrics/doctor/edge_repair.hpp"
#include "metrics/doctor/signed_axes.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

Pose unchanged(const Pose& p, const EdgeContext&) { return p; }
Pose inverted(const Pose& p, const EdgeContext&) { return p.inverse(); }
Pose reordered(const Pose& p, const EdgeContext&) {
  const Rotation& q = p.rotation;
  return {Rotation(q.x(), q.y(), q.z(), q.w()), p.translation};
}

Pose read_in_degrees(const Pose& p, const EdgeContext& context) {
  const Vector3 read = log_so3(p.rotation);
  const double angle = read.norm();
  if (angle == 0.0) return p;
  const Vector3 axis = read / angle;
  // Angles in degrees that were read as radians are known up to full rotations.
  const double expected = kDegrees * log_so3(context.predicted).dot(axis);
  const double rotations = std::round((expected - angle) / (2.0 * M_PI));
  return {exp_so3((angle + 2.0 * M_PI * rotations) / kDegrees * axis), p.translation};
}

/// Adds the repair, and the one of edges that the file lists from `to` to `from`.
void add_both_ways(std::vector<EdgeRepair>& to, const EdgeRepair& repair) {
  to.push_back(repair);
  to.push_back(repair);
  to.back().change = [change = repair.change](const Pose& p, const EdgeContext& c) {
    return change(p.inverse(), {c.predicted.conjugate(), c.world_from_to, c.world_from_from})
        .inverse();
  };
}

/// Translations of `edges` in millimetres or centimetres, or those of the other edges: what has to
/// be written in metres in these cases.
std::vector<EdgeRepair> unit_repairs(const std::string& edges,
                                     const std::string& if_larger,
                                     const std::string& if_smaller) {
  std::vector<EdgeRepair> out;
  for (const double factor : {0.001, 0.01, 0.3048, 1.0 / 0.3048, 100.0, 1000.0}) {
    out.push_back({Fault::closure_unit,
                   fmt::format("multiplying the translations of {} by {:g}", edges, factor),
                   fmt::format("write {} in metres", factor < 1.0 ? if_larger : if_smaller),
                   [=](const Pose& p, const EdgeContext&) -> Pose {
                     return {p.rotation, factor * p.translation};
                   },
                   0.0,
                   0.0,
                   false,
                   std::min(0.3, std::sqrt(factor))});  // shrinking removes noise, too
  }
  return out;
}

void add_rotations(std::vector<EdgeRepair>& to) {
  add_both_ways(
      to,
      {Fault::closure_rotation,
       "inverting the closures' rotations, but not their translations,",
       "write the rotations that map vectors from the second vertex's body to the first one's",
       [](const Pose& p, const EdgeContext&) -> Pose {
         return {p.rotation.conjugate(), p.translation};
       }});
  add_both_ways(to,
                {Fault::closure_rotation,
                 "quaternions of the closures in the order w x y z",
                 "write their quaternions as x y z w",
                 reordered});
  add_both_ways(to,
                {Fault::closure_rotation,
                 "quaternions of the closures, once read as w x y z instead of x y z w,",
                 "write their quaternions as x y z w",
                 [](const Pose& p, const EdgeContext&) -> Pose {
                   const Rotation& q = p.rotation;
                   return {Rotation(q.z(), q.w(), q.x(), q.y()), p.translation};
                 }});
  add_both_ways(to,
                {Fault::closure_rotation,
                 "multiplying the closures' angles by 57.3",
                 "write their angles in radians, converted once",
                 [](const Pose& p, const EdgeContext&) -> Pose {
                   return {exp_so3(kDegrees * log_so3(p.rotation)), p.translation};
                 }});
  add_both_ways(to,
                {Fault::closure_rotation,
                 "the closures' angles in degrees",
                 "write their angles in radians",
                 read_in_degrees,
                 0.0,
                 std::log(kDegrees)});
}

void add_frames(std::vector<EdgeRepair>& to) {
  add_both_ways(to,
                {Fault::closure_frame,
                 "taking the closures' translations as those in axes of the world",
                 "rotate them into the body where each closure begins",
                 [](const Pose& p, const EdgeContext& c) -> Pose {
                   return {p.rotation, c.world_from_from.rotation.conjugate() * p.translation};
                 },
                 std::log(24.0)});
  add_both_ways(
      to,
      {Fault::closure_frame,
       "taking the closures as poses in the world",
       "write the pose of the second vertex in the first one's body",
       [](const Pose& p, const EdgeContext& c) { return c.world_from_from.inverse() * p; },
       std::log(24.0)});
  for (int axis = 0; axis < 3; ++axis) {
    to.push_back({Fault::closure_frame,
                  fmt::format("mirroring {} of the closures", "xyz"[axis]),
                  "write translations and rotations in right-handed axes",
                  [=](const Pose& p, const EdgeContext&) { return mirrored(p, axis); },
                  std::log(24.0)});
  }
  for (const auto& [axes, option] : signed_axes()) {
    if (axes.determinant() < 0.0) continue;
    const Rotation body(axes);
    to.push_back({Fault::closure_frame,
                  "taking " + option + " of the closures' body as x,y,z",
                  "transform them into the odometry's body: C T C^-1 for each closure T",
                  [=](const Pose& p, const EdgeContext&) -> Pose {
                    return {body * p.rotation * body.conjugate(), body * p.translation};
                  },
                  std::log(24.0)});
  }
}

}  // namespace

const EdgeRepair& as_read_edge() {
  static const EdgeRepair out{{}, "", "", unchanged};
  return out;
}

const std::vector<EdgeRepair>& closure_repairs() {
  static const std::vector<EdgeRepair> out = [] {
    std::vector<EdgeRepair> all = unit_repairs("the closures", "the closures", "the odometry");
    all.push_back(
        {Fault::closure_direction,
         "inverting the closures (or all odometry)",
         "exchange the two vertices of each closure; in a file of loops the first two columns",
         inverted});
    add_rotations(all);
    add_frames(all);
    return all;
  }();
  return out;
}

const std::vector<EdgeRepair>& odometry_repairs() {
  static const std::vector<EdgeRepair> out = [] {
    std::vector<EdgeRepair> all =
        unit_repairs("the odometry", "all edges and vertices", "all edges and vertices");
    all.push_back({Fault::odometry_direction,
                   "inverting the odometry",
                   "exchange the two vertices of each odometry edge",
                   inverted});
    all.push_back({Fault::quaternion_order,
                   "all quaternions in the order w x y z",
                   "write the quaternions of all edges and vertices as x y z w",
                   reordered,
                   0.0,
                   0.0,
                   true});
    return all;
  }();
  return out;
}

}  // namespace loopbench::metrics
