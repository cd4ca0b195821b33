#include "harness/trajectory/conventions.hpp"

#include <fmt/format.h>

#include <cmath>

namespace loopbench::harness {
namespace {

[[noreturn]] void reject_axes(const std::string& text) {
  throw InputError("--axes: found '" + text +
                   "', expected x, y and z in any order, each with an optional minus, such as "
                   "--axes=-y,x,z");
}

Matrix3 signed_permutation(const std::string& text) {
  Matrix3 out = Matrix3::Zero();
  int row = 0;
  double sign = 1.0;
  for (const char c : text) {
    if (c == ' ' || c == ',') continue;
    if (c == '-' && sign > 0.0) {
      sign = -1.0;
      continue;
    }
    if (c < 'x' || c > 'z' || row == 3) reject_axes(text);
    out(row++, c - 'x') = sign;
    sign = 1.0;
  }
  if (row != 3 || sign < 0.0 || !out.colwise().any().all()) reject_axes(text);
  return out;
}

void check_factor(const char* name, double factor) {
  if (factor > 0.0 && std::isfinite(factor)) return;
  throw InputError(fmt::format("{} = {:g}, expected a number > 0", name, factor));
}

/// The reader has put each component one place further, or one place back.
Rotation reordered(const Rotation& q, const std::string& actual) {
  return actual == "wxyz" ? Rotation(q.x(), q.y(), q.z(), q.w())
                          : Rotation(q.z(), q.w(), q.x(), q.y());
}

}  // namespace

bool Conventions::any() const {
  return !quaternion_order.empty() || conjugate || !axes.empty() || scale != 1.0 ||
         stamp_scale != 1.0 || invert_poses;
}

TrajectoryFile corrected(TrajectoryFile file, const Conventions& conventions) {
  if (!conventions.any()) return file;
  const std::string& order = conventions.quaternion_order;
  if (!order.empty() && order != "wxyz" && order != "xyzw") {
    throw InputError("--quaternion-order = " + order + ", expected wxyz or xyzw");
  }
  check_factor("--scale", conventions.scale);
  check_factor("--stamp-scale", conventions.stamp_scale);
  const Matrix3 axes =
      conventions.axes.empty() ? Matrix3::Identity() : signed_permutation(conventions.axes);
  for (auto& [stamp, pose] : file.poses) {
    if (!order.empty()) pose.rotation = reordered(pose.rotation, order);
    if (conventions.conjugate) pose.rotation = pose.rotation.conjugate();
    pose.translation = conventions.scale * (axes * pose.translation);
    stamp *= conventions.stamp_scale;
    if (conventions.invert_poses) pose = normalized(pose.inverse());
  }
  file.covariances.clear();
  if (conventions.stamp_scale != 1.0) file.nanoseconds.clear();
  return file;
}

}  // namespace loopbench::harness
