#include "metrics/alignment/hand_eye/lever_arm_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/core/upper_median.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kMotionRounding = 1e-18;  // of the squared motion; below it nothing is explained

/// Unknowns: lever arm c, scale error s, and drift k per relative pose.
using LeverArmUnknowns = Eigen::Matrix<double, 7, 1>;

Vector3 residual(const LeverArmEquation& e, const LeverArmUnknowns& x) {
  return e.difference - e.rotation_minus_identity * x.head<3>() - x[3] * e.translation -
         x.tail<3>();
}

struct LeverArmEstimate {
  LeverArmUnknowns x;
  Matrix3 covariance;  ///< of c
};

/// Least squares with noise `sigma` and priors on s and k.
LeverArmEstimate estimate_at(const std::vector<LeverArmEquation>& all,
                             double sigma,
                             double length) {
  constexpr double kScale = 10.0;  // prior std of s: uninformative
  constexpr double kDrift = 0.05;  // prior std of k, relative to the distance
  constexpr double kRegularisation = 1e-12;
  Eigen::Matrix<double, 7, 7> information = Eigen::Matrix<double, 7, 7>::Zero();
  LeverArmUnknowns right = LeverArmUnknowns::Zero();
  Eigen::Matrix<double, 3, 7> row;
  row.rightCols<3>().setIdentity();
  for (const auto& [rotation_minus_identity, along, difference, weight] : all) {
    row.leftCols<3>() = rotation_minus_identity;
    row.col(3) = along;
    information += weight * row.transpose() * row;
    right += weight * row.transpose() * difference;
  }
  const double square = sigma * sigma;
  information(3, 3) += square / (kScale * kScale);
  information.diagonal().tail<3>().array() += square / (kDrift * kDrift * length * length);
  // Keeps the inverse finite in unobservable directions of c, with a large variance.
  information.diagonal().head<3>().array() +=
      kRegularisation * information.topLeftCorner<3, 3>().trace();
  const Eigen::LDLT<Eigen::Matrix<double, 7, 7>> factor(information);
  const Eigen::Matrix<double, 7, 3> first = Eigen::Matrix<double, 7, 3>::Identity();
  return {factor.solve(right), square * factor.solve(first).topRows<3>()};
}

/// Sets c to zero along axes of its covariance in which it is not significant. Also drops an axis
/// if its information from rotation is a thousand times less than that of the best axis: in planar
/// motion the height is unobservable, and small orientation errors would be divided by near zero.
LeverArmFit significant_part(const LeverArmEstimate& found) {
  constexpr double kSignificance = 3.0;  // standard deviations
  constexpr double kWorst = 1e3;         // times the standard deviation of the best axis
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(found.covariance);
  Vector3 sure = Vector3::Zero();
  Vector3 variance = Vector3::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vector3 axis = axes.eigenvectors().col(i);
    const double square = std::max(0.0, axes.eigenvalues()[i]);
    const double along = axis.dot(found.x.head<3>());
    if (along * along < kSignificance * kSignificance * square) continue;
    if (square > kWorst * kWorst * std::max(0.0, axes.eigenvalues()[0])) continue;
    sure += along * axis;
    variance += square * axis.cwiseAbs2();
  }
  return {sure, variance.cwiseSqrt(), 0.0};
}

/// Sum of squared residuals for a lever arm, minimised over the scale; without drift, so the mean
/// counts.
double remaining_squares(const std::vector<LeverArmEquation>& all,
                         const Vector3& lever_arm,
                         double& scale) {
  double length = 0.0, across = 0.0, out = 0.0;
  for (const LeverArmEquation& e : all) {
    length += e.weight * e.translation.squaredNorm();
    across += e.weight * e.translation.dot(e.difference - e.rotation_minus_identity * lever_arm);
  }
  scale = length > 0.0 ? across / length : 0.0;
  for (const LeverArmEquation& e : all) {
    out += e.weight * (e.difference - e.rotation_minus_identity * lever_arm - scale * e.translation)
                          .squaredNorm();
  }
  return out;
}

/// At most kMostEquations of them, which determine a lever arm to a fraction of its use.
std::vector<LeverArmEquation> evenly_chosen(std::vector<LeverArmEquation> all) {
  constexpr std::size_t kMostEquations = 20'000;
  const std::size_t step = (all.size() + kMostEquations - 1) / kMostEquations;
  if (step <= 1) return all;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all.size(); i += step) all[kept++] = all[i];
  all.resize(kept);
  return all;
}

}  // namespace

LeverArmFit fit_lever_arm(std::vector<LeverArmEquation> all) {
  all = evenly_chosen(std::move(all));
  constexpr int kRounds = 20;
  constexpr double kConverged = 1e-6;
  constexpr double kHuber = 2.0, kJump = 6.0;  // times the residuals' scale
  constexpr double kMedianOf3d = 1.54;         // of a standard normal vector's length
  const auto count = static_cast<double>(all.size());
  double squares = 0.0;
  for (const LeverArmEquation& e : all)
    squares += e.translation.squaredNorm() + e.difference.squaredNorm();
  const double length = std::sqrt(squares / count);
  if (!(length > 0.0)) return {};
  double sigma = length;
  std::vector<double> lengths(all.size());
  LeverArmEstimate found;
  for (int round = 0; round < kRounds; ++round) {
    found = estimate_at(all, sigma, length);
    for (std::size_t k = 0; k < all.size(); ++k) lengths[k] = residual(all[k], found.x).norm();
    std::vector<double> sorted = lengths;
    const double median = upper_median(sorted);
    const double last = std::exchange(sigma, std::max(median / kMedianOf3d, 1e-9 * length));
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k].weight = lengths[k] > kHuber * sigma ? kHuber * sigma / lengths[k] : 1.0;
    }
    if (std::abs(sigma - last) <= kConverged * sigma) break;
  }
  LeverArmFit out = significant_part(found);
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k].weight = lengths[k] > kJump * sigma ? 0.0 : 1.0;
  }
  double scale = 0.0;
  const double before = remaining_squares(all, Vector3::Zero(), scale);
  const double after = remaining_squares(all, out.lever_arm, scale);
  // Zero, not significant, or the estimate does not move.
  if (before <= kMotionRounding * squares || after >= before || scale >= 1.0) return {};
  out.explained = 1.0 - after / before;
  out.lever_arm /= 1.0 - scale;
  out.deviation /= 1.0 - scale;
  return out;
}

}  // namespace loopbench::metrics
