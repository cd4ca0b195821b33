#include "metrics/doctor/conventions.hpp"

#include <algorithm>
#include <array>

#include "datasets/core/mirrored.hpp"
#include "datasets/core/se3.hpp"

namespace loopbench::metrics {
namespace {

PoseChange of_rotation(Rotation (*change)(const Rotation&)) {
  return [=](const Pose& p) -> Pose { return {change(p.rotation), p.translation}; };
}

void add_axes(bool of_closures, std::vector<Convention>& out) {
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3 axes = Matrix3::Zero();
      std::string names;
      for (int row = 0; row < 3; ++row) {
        const bool is_negative = (signs >> row & 1) != 0;
        const int column = order[static_cast<std::size_t>(row)];
        axes(row, column) = is_negative ? -1.0 : 1.0;
        names += std::string(row == 0 ? "" : ",") + (is_negative ? "-" : "") + "xyz"[column];
      }
      const double unusual = 0.5 * (axes - Matrix3::Identity()).squaredNorm();
      const bool is_mirrored = axes.determinant() < 0.0;
      if (unusual == 0.0 || (of_closures && is_mirrored)) continue;
      const Rotation body(is_mirrored ? Matrix3(-axes) : axes);
      out.push_back({is_mirrored ? Fault::mirrored : Fault::axes,
                     "taking " + names + " as x,y,z in the " + (of_closures ? "body" : "positions"),
                     "--axes=" + names,
                     unusual,
                     [=](const Pose& p) -> Pose {
                       if (of_closures)
                         return {body * p.rotation * body.conjugate(), body * p.translation};
                       return {p.rotation, axes * p.translation};
                     }});
    }
  } while (std::ranges::next_permutation(order).found);
}

}  // namespace

std::vector<Convention> conventions(bool of_closures) {
  std::vector<Convention> out{
      {Fault::quaternion_order,
       "quaternions in the order w x y z",
       "--quaternion-order wxyz",
       0.0,
       of_rotation([](const Rotation& q) { return Rotation(q.x(), q.y(), q.z(), q.w()); })},
      {Fault::quaternion_order,
       "quaternions, once read as w x y z instead of x y z w,",
       "--quaternion-order wxyz (three times, each moves them by one)",
       1.0,
       of_rotation([](const Rotation& q) { return Rotation(q.z(), q.w(), q.x(), q.y()); })},
      {Fault::inverted_poses,
       "inverting the rotations, but not the positions,",
       "--conjugate",
       1.0,
       of_rotation([](const Rotation& q) { return Rotation(q.conjugate()); })},
      {Fault::inverted_poses, "inverting the poses", "--invert-poses", 0.0, [](const Pose& p) {
         return p.inverse();
       }}};
  if (!of_closures) {
    out.push_back({Fault::inverted_poses,
                   "inverting the positions, but not the rotations,",
                   "--conjugate, then --invert-poses",
                   1.0,
                   [](const Pose& p) -> Pose {
                     return {p.rotation, -(p.rotation * p.translation)};
                   }});
  }
  for (int axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    out.push_back({Fault::mirrored,
                   std::string("mirroring ") + name + " of positions and rotations",
                   std::string("--mirror ") + name,
                   2.5,
                   [=](const Pose& p) { return mirrored(p, axis); }});
  }
  add_axes(of_closures, out);
  return out;
}

}  // namespace loopbench::metrics
