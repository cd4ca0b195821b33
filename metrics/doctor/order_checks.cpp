#include "metrics/doctor/order_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "datasets/core/closest_rotation.hpp"
#include "metrics/doctor/agreement.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kMostAfterRows = 0.25, kOfSpread = 0.2;

/// Position error after an alignment with scale, on poses that were not fitted.
struct TestedError {
  double metres = 0.0;
  double spread = 0.0;
};

std::optional<TestedError> tested_error(const Trajectory& reference, const Trajectory& estimate) {
  const Paired poses = common_poses(reference, estimate);
  if (poses.estimate.size() < kFewestCommonPoses) return std::nullopt;
  const Agreement found = agreement(poses);
  return TestedError{position_error(poses, similarity(poses)), found.spread};
}

struct RowRepair {
  Fault::Name fault;
  const char* subject;  ///< "the rows", of a file
  std::string what;     ///< "are motions from one row to the next"
  std::string fix;      ///< ends before the file; of degrees, the names of their columns
  Trajectory (*change)(const Trajectory&);
};

Trajectory in_order_of_numbers(const Trajectory& file) {
  const std::vector<std::size_t> numbers = numbers_sorted_as_text(file.size());
  Trajectory out = file;
  for (std::size_t i = 0; i < file.size(); ++i) {
    out[numbers[i]].world_from_body = file[i].world_from_body;
  }
  return out;
}

Trajectory in_metres(const Trajectory& file) { return from_degrees(file, false).value_or(file); }

Trajectory in_metres_swapped(const Trajectory& file) {
  return from_degrees(file, true).value_or(file);
}

std::vector<RowRepair> row_repairs(bool of_rows) {
  std::vector<RowRepair> out;
  if (of_rows) {
    out.push_back({Fault::row_order,
                   "the rows",
                   "are those of files that were sorted as text (0, 1, 10, 100)",
                   "write the rows in the order of their numbers (ls -v, sort -n) in ",
                   in_order_of_numbers});
  }
  out.push_back({Fault::relative_poses,
                 "the rows",
                 "are motions from one row to the next",
                 "traj transform --chain ",
                 chained});
  out.push_back({Fault::degrees,
                 "x and y",
                 "are latitude and longitude in degrees",
                 "latitude,longitude,height",
                 in_metres});
  out.push_back({Fault::degrees,
                 "x and y",
                 "are longitude and latitude in degrees",
                 "longitude,latitude,height",
                 in_metres_swapped});
  return out;
}

std::string fix_of(const RowRepair& repair, const Trajectory& file) {
  if (repair.fault != Fault::degrees) return repair.fix;
  // Without rotations, there may be columns of zeros.
  const char* const rest = lacks_rotations(file)
                               ? "' above rows with commas of the first four columns of "
                               : ",qx,qy,qz,qw' above rows with commas of ";
  return "write a first line 'timestamp," + repair.fix + rest;
}

}  // namespace

std::vector<std::size_t> numbers_sorted_as_text(std::size_t count) {
  std::vector<std::size_t> out(count);
  std::iota(out.begin(), out.end(), std::size_t{0});
  std::vector<std::string> names;
  for (const std::size_t number : out) names.push_back(std::to_string(number));
  std::ranges::sort(
      out, {}, [&](std::size_t number) -> const std::string& { return names[number]; });
  return out;
}

Trajectory chained(const Trajectory& motions) {
  Trajectory out = motions;
  for (std::size_t i = 1; i < out.size(); ++i) {
    out[i].world_from_body = normalized(out[i - 1].world_from_body * motions[i].world_from_body);
  }
  return out;
}

std::optional<Trajectory> from_degrees(const Trajectory& positions, bool is_longitude_first) {
  constexpr double kMetres = 6.371e6 * std::numbers::pi / 180.0, kMostSpread = 1.0;  // [deg]
  if (positions.empty()) return std::nullopt;
  const Eigen::Index latitude = is_longitude_first ? 1 : 0;
  const Vector3 first = positions.front().world_from_body.translation;
  const double cosine = std::cos(first[latitude] * std::numbers::pi / 180.0);
  Trajectory out = positions;
  for (auto& [stamp, pose] : out) {
    const Vector3 change = pose.translation - first;
    const bool is_possible = std::abs(pose.translation[latitude]) <= 90.0 &&
                             std::abs(pose.translation[1 - latitude]) <= 360.0 &&
                             change.head<2>().norm() <= kMostSpread;
    if (!is_possible) return std::nullopt;
    pose.translation = {
        kMetres * cosine * change[1 - latitude], kMetres * change[latitude], change[2]};
  }
  return out;
}

std::optional<InputFinding> check_rows(const Trajectory& reference,
                                       const Trajectory& estimate,
                                       bool has_stamps) {
  constexpr std::size_t kMostRows = 200'000;  // reading them costs more than these checks
  if (std::max(reference.size(), estimate.size()) > kMostRows) return std::nullopt;
  const auto before = tested_error(reference, estimate);
  if (!before) return std::nullopt;
  const bool of_rows = !has_stamps && reference.size() == estimate.size();
  for (const RowRepair& repair : row_repairs(of_rows)) {
    for (const bool of_reference : {false, true}) {
      const bool needs_rotations = repair.fault == Fault::relative_poses;
      const Trajectory& file = of_reference ? reference : estimate;
      if (needs_rotations && lacks_rotations(file)) continue;
      const Trajectory changed = repair.change(file);
      const auto after =
          of_reference ? tested_error(changed, estimate) : tested_error(reference, changed);
      if (!after || !(after->spread > 0.0)) continue;
      const double was = before->metres / before->spread, is = after->metres / after->spread;
      if (!(is < kMostAfterRows * was && is < kOfSpread)) continue;
      return InputFinding{
          repair.fault,
          fmt::format("{} of the {} {}: position error after alignment with scale {:.3g} -> {:.3g} "
                      "% of the reference's spread",
                      repair.subject,
                      of_reference ? "reference" : "estimate",
                      repair.what,
                      100.0 * was,
                      100.0 * is),
          fix_of(repair, file) + (of_reference ? "REF" : "EST"),
          1.0 - is / was,
          100.0 * is};
    }
  }
  return std::nullopt;
}

std::optional<InputFinding> check_shear(const Paired& poses) {
  constexpr double kMostAfter = 0.2, kLeastSpread = 0.03, kUnequal = 1.05, kFlat = 0.1;
  const Paired fitted = fitted_part(poses);
  const auto count = static_cast<Eigen::Index>(fitted.estimate.size());
  if (fitted.estimate.size() < kFewestCommonPoses) return std::nullopt;
  const auto matrix = [&](const Trajectory& list) {
    Eigen::Matrix3Xd out(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      out.col(i) = list[static_cast<std::size_t>(i)].world_from_body.translation;
    }
    return out;
  };
  Eigen::Matrix3Xd x = matrix(fitted.estimate), y = matrix(fitted.reference);
  const Vector3 of_x = x.rowwise().mean(), of_y = y.rowwise().mean();
  x.colwise() -= of_x;
  y.colwise() -= of_y;
  // Only axes along which the estimate extends.
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(x * x.transpose());
  Matrix3 inverse = Matrix3::Zero(), extended = Matrix3::Zero();
  int dimensions = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double square = axes.eigenvalues()[k];
    if (square <= kLeastSpread * kLeastSpread * axes.eigenvalues()[2]) continue;
    const Vector3 axis = axes.eigenvectors().col(k);
    inverse += axis * axis.transpose() / square;
    extended += axis * axis.transpose();
    ++dimensions;
  }
  if (dimensions < 2) return std::nullopt;
  const Eigen::Affine3d similar = similarity(fitted);
  const double scale = std::cbrt(similar.linear().determinant());
  // Other axes as in the similarity.
  const Matrix3 linear =
      y * x.transpose() * inverse + similar.linear() * (Matrix3::Identity() - extended);
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.linear() = linear;
  map.translation() = of_y - linear * of_x;
  Vector3 sizes = singular_values(linear) / scale;
  const double was = position_error(poses, similarity(poses)), is = position_error(poses, map);
  // An axis that nearly vanishes is noise of the estimate across a plane.
  if (!(is < kMostAfter * was) || sizes[0] < kUnequal * sizes[2] || sizes[2] < kFlat * sizes[0])
    return std::nullopt;
  return InputFinding{
      Fault::sheared,
      fmt::format("the positions agree if axes have different units, with ratios {:.3f} (singular "
                  "values): position error {:.3g} -> {:.3g} m",
                  fmt::join(sizes, " : "),
                  was,
                  is),
      "write all axes in metres (longitudes times the cosine of the latitude)",
      1.0 - is / was,
      sizes[0] / sizes[2]};
}

}  // namespace loopbench::metrics
