#include "metrics/doctor/axis_fit.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

namespace loopbench::metrics {
namespace {

/// The signed permutations, those that move fewer axes first.
std::vector<Matrix3> signed_permutations() {
  std::vector<Matrix3> out;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3 matrix = Matrix3::Zero();
      for (int row = 0; row < 3; ++row) {
        matrix(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1.0 : 1.0;
      }
      out.push_back(matrix);
    }
  } while (std::ranges::next_permutation(order).found);
  std::ranges::stable_sort(
      out, {}, [](const Matrix3& m) { return (m - Matrix3::Identity()).squaredNorm(); });
  return out;
}

/// Displacements [m]: the reference's in its body frame; the estimate's in its world, with the
/// rotation of its body.
struct Displacement {
  Vector3 reference;
  Vector3 estimate;
  Rotation body_from_world;
};

std::vector<Displacement> displacements(const std::vector<Pose>& reference,
                                        const std::vector<Pose>& estimate) {
  std::vector<Displacement> out;
  const std::size_t step = reference.size() / 100 + 1;
  for (std::size_t i = 0; i + step < reference.size(); ++i) {
    const Pose& r = reference[i];
    const Pose& e = estimate[i];
    out.push_back({r.rotation.conjugate() * (reference[i + step].translation - r.translation),
                   estimate[i + step].translation - e.translation,
                   e.rotation.conjugate()});
  }
  return out;
}

/// Error after the best rotation and scale, relative to the reference's displacements.
double relative_error(const std::vector<Displacement>& all, const Matrix3& axes) {
  Matrix3 products = Matrix3::Zero();
  double of_reference = 0.0, of_estimate = 0.0;
  for (const Displacement& each : all) {
    const Vector3 moved = each.body_from_world * (axes * each.estimate);
    products += each.reference * moved.transpose();
    of_reference += each.reference.squaredNorm();
    of_estimate += moved.squaredNorm();
  }
  if (!(of_reference > 0.0) || !(of_estimate > 0.0)) return 0.0;
  const Eigen::JacobiSVD<Matrix3> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3& d = svd.singularValues();
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const double correlation = d[0] + d[1] + sign * d[2];
  return std::sqrt(std::max(0.0, 1.0 - correlation * correlation / (of_reference * of_estimate)));
}

}  // namespace

std::string AxisFit::text() const {
  std::string out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (axes(row, column) == 0.0) continue;
      out += std::string(out.empty() ? "" : " ") + (axes(row, column) < 0.0 ? "-" : "") +
             "xyz"[column];
    }
  }
  return out;
}

std::string AxisFit::option() const {
  std::string out = text();
  std::ranges::replace(out, ' ', ',');
  return out;
}

AxisFit fit_axes(const std::vector<Pose>& reference, const std::vector<Pose>& estimate) {
  AxisFit out;
  if (reference.size() < 8) return out;
  constexpr double kEqual = 1.1;  // of errors that do not distinguish permutations
  const std::vector<Displacement> all = displacements(reference, estimate);
  const std::vector<Matrix3> permutations = signed_permutations();
  std::vector<double> errors;
  for (const Matrix3& each : permutations) errors.push_back(relative_error(all, each));
  const double least = *std::ranges::min_element(errors);
  const auto chosen = static_cast<std::size_t>(
      std::ranges::find_if(errors, [&](double e) { return e <= kEqual * least; }) - errors.begin());
  return {permutations[chosen], errors.front(), errors[chosen]};
}

}  // namespace loopbench::metrics
