#include "metrics/alignment/hand_eye.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "datasets/core/closest_rotation.hpp"
#include "datasets/core/so3.hpp"
#include "datasets/core/upper_median.hpp"

namespace loopbench::metrics {

namespace {

struct RotationFit {
  Rotation body_from_reference = Rotation::Identity();
  double explained = 0.0;  ///< share of the squared differences of rotations and displacements [-]
};

constexpr double kExplains = 0.5;  // share of the squares, to accept
constexpr double kMinRotation =
    5.0 * std::numbers::pi / 180.0;   // below: a tilt, unobservable in 2-D
constexpr double kSecondAxis = 0.02;  // of the first singular value
constexpr double kNothing = 1e-18;    // of the squared motion; below it nothing is explained

/// Sums of squared rotations and displacements, each normalised by its own size.
struct MotionSizes {
  double rotations = 0.0;
  double translations = 0.0;
};

MotionSizes sizes_of(const std::vector<RelativePosePair>& pairs) {
  MotionSizes out;
  for (const auto& [q, z] : pairs) {
    out.rotations += log_so3(z.rotation).squaredNorm();
    out.translations += q.translation.squaredNorm() + z.translation.squaredNorm();
  }
  return out;
}

double difference(const std::vector<RelativePosePair>& pairs,
                  const MotionSizes& sizes,
                  const Rotation& rotation) {
  double out = 0.0;
  for (const auto& [q, z] : pairs) {
    out += (log_so3(z.rotation) - rotation * log_so3(q.rotation)).squaredNorm() / sizes.rotations;
    if (sizes.translations > 0.0)
      out += (z.translation - rotation * q.translation).squaredNorm() / sizes.translations;
  }
  return out;
}

/// The closest rotation, with w >= 0 as in files.
Rotation rotation_of(const Matrix3& m) {
  Rotation rotation(closest_rotation(m));
  if (rotation.w() < 0.0) rotation.coeffs() *= -1.0;
  return rotation.normalized();
}

/// Maps the reference's motions to the estimate's in least squares: Kabsch, of rotation vectors,
/// and of displacements if all rotations have one axis. Identity if the angle is below 5 degrees or
/// the rotation does not explain half of the differences. O(pairs).
RotationFit fit_rotation(const std::vector<RelativePosePair>& pairs) {
  const MotionSizes sizes = sizes_of(pairs);
  Matrix3 rotations = Matrix3::Zero();
  Matrix3 translations = Matrix3::Zero();
  for (const auto& [q, z] : pairs) {
    rotations += log_so3(z.rotation) * log_so3(q.rotation).transpose() / sizes.rotations;
    if (sizes.translations > 0.0)
      translations += z.translation * q.translation.transpose() / sizes.translations;
  }
  // Displacements also depend on the unknown lever arm: use them only if all rotations share an
  // axis.
  const Vector3 sizes_of_axes = singular_values(rotations);
  const bool about_one_axis = sizes_of_axes[1] <= kSecondAxis * sizes_of_axes[0];
  const Rotation rotation = rotation_of(about_one_axis ? rotations + translations : rotations);
  const double before = difference(pairs, sizes, Rotation::Identity());
  if (before <= kNothing || log_so3(rotation).norm() < kMinRotation) return {};
  const double explained = 1.0 - difference(pairs, sizes, rotation) / before;
  if (explained < kExplains) return {};
  return {rotation, explained};
}

/// One pair of relative poses: difference = rotation_minus_identity c + s translation + k, with
/// difference = R_C t_Q - t_Z, rotation_minus_identity = R_Z - I and translation = R_C t_Q.
struct LeverArmEquation {
  Matrix3 rotation_minus_identity;
  Vector3 translation;
  Vector3 difference;
  double weight = 1.0;
};

struct LeverArmFit {
  Vector3 lever_arm = Vector3::Zero();  ///< c in the reference's scale; 0 if not significant [m]
  Vector3 deviation = Vector3::Zero();  ///< standard deviations [m]; 0: not significant
  double explained = 0.0;  ///< share of the squared residuals explained by c beyond the scale [-]
};

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

/// Least squares with Huber weights, free scale, and drift of a few per cent per relative pose.
/// Directions closer than three standard deviations to zero are set to zero. Of more than 20 000
/// equations, about so many are used, evenly chosen. See hand_eye(). O(equations).
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

}  // namespace

std::vector<RelativePosePair> rotating_intervals(const Trajectory& reference,
                                                 const Trajectory& estimate,
                                                 double angle,
                                                 double longest) {
  const double cosine = std::cos(0.5 * angle);
  const auto has_rotated = [&](const Trajectory& poses, std::size_t from, std::size_t to) {
    const Rotation& a = poses[from].world_from_body.rotation;
    return std::abs(a.dot(poses[to].world_from_body.rotation)) <= cosine;
  };
  const auto motion = [](const Trajectory& poses, std::size_t from, std::size_t to) {
    return poses[from].world_from_body.inverse() * poses[to].world_from_body;
  };
  std::vector<RelativePosePair> out;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    const bool is_late = estimate[i].stamp - estimate[begin].stamp > longest;
    const bool rotated = has_rotated(estimate, begin, i) && has_rotated(reference, begin, i);
    if (rotated && !is_late)
      out.push_back({motion(reference, begin, i), motion(estimate, begin, i)});
    if (rotated || is_late) begin = i;
  }
  return out;
}

HandEye hand_eye(const std::vector<RelativePosePair>& pairs) {
  const RotationFit rotation = fit_rotation(pairs);
  std::vector<LeverArmEquation> equations;
  equations.reserve(pairs.size());
  for (const auto& [q, z] : pairs) {
    const Vector3 translation = rotation.body_from_reference * q.translation;
    equations.push_back({z.rotation.toRotationMatrix() - Matrix3::Identity(),
                         translation,
                         translation - z.translation});
  }
  const LeverArmFit lever_arm = fit_lever_arm(std::move(equations));
  return {{rotation.body_from_reference, lever_arm.lever_arm},
          lever_arm.deviation,
          rotation.explained,
          lever_arm.explained};
}

}  // namespace loopbench::metrics
