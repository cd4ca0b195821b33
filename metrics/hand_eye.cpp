#include "metrics/hand_eye.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopbench {
namespace {

constexpr double kExplains = 0.5;                              // of the squares, to be believed
constexpr double kLeastTurn = 5.0 * std::numbers::pi / 180.0;  // less: a tilt, unseen in a plane
constexpr double kHardlyTold = 0.02;  // a second axis of turning, of the first
constexpr double kRounding = 1e-18;   // of squared motion: nothing is left to explain

/// Sums of squared turns and ways: each counts in parts of its own size.
struct MotionSizes {
  double turns = 0.0;
  double ways = 0.0;
};

MotionSizes sizes_of(const std::vector<MotionPair>& pairs) {
  MotionSizes out;
  for (const auto& [q, z] : pairs) {
    out.turns += log_so3(z.rotation).squaredNorm();
    out.ways += q.translation.squaredNorm() + z.translation.squaredNorm();
  }
  return out;
}

double difference(const std::vector<MotionPair>& pairs,
                  const MotionSizes& sizes,
                  const Rotation& turn) {
  double out = 0.0;
  for (const auto& [q, z] : pairs) {
    out += (log_so3(z.rotation) - turn * log_so3(q.rotation)).squaredNorm() / sizes.turns;
    if (sizes.ways > 0.0) out += (z.translation - turn * q.translation).squaredNorm() / sizes.ways;
  }
  return out;
}

/// Kabsch's rotation.
Rotation turn_of(const Eigen::JacobiSVD<Matrix3>& svd) {
  Matrix3 flip = Matrix3::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Rotation turn(Matrix3(svd.matrixU() * flip * svd.matrixV().transpose()));
  if (turn.w() < 0.0) turn.coeffs() *= -1.0;  // the same turn, in the form that files have
  return turn.normalized();
}

void fit_turn(const std::vector<MotionPair>& pairs, HandEye& out) {
  const MotionSizes sizes = sizes_of(pairs);
  Matrix3 turns = Matrix3::Zero();
  Matrix3 ways = Matrix3::Zero();
  for (const auto& [q, z] : pairs) {
    turns += log_so3(z.rotation) * log_so3(q.rotation).transpose() / sizes.turns;
    if (sizes.ways > 0.0) ways += z.translation * q.translation.transpose() / sizes.ways;
  }
  constexpr unsigned kWhole = Eigen::ComputeFullU | Eigen::ComputeFullV;
  Eigen::JacobiSVD<Matrix3> svd(turns, kWhole);
  // Displacements depend on the place sought, too: they only help where all turn about one axis.
  const bool about_one_axis = svd.singularValues()[1] <= kHardlyTold * svd.singularValues()[0];
  if (about_one_axis) svd.compute(turns + ways, kWhole);
  const Rotation turn = turn_of(svd);
  const double before = difference(pairs, sizes, Rotation::Identity());
  if (before <= kRounding || log_so3(turn).norm() < kLeastTurn) return;
  const double explained = 1.0 - difference(pairs, sizes, turn) / before;
  if (explained < kExplains) return;
  out.body_from_reference.rotation = turn;
  out.turn_explained = explained;
}

/// moved = turned c + s way + k, a pair each: R_C t_Q - t_Z, R_Z - I and R_C t_Q.
struct LeverEquation {
  Matrix3 turned;
  Vector3 way;
  Vector3 moved;
  double weight = 1.0;
};

/// The place c, the error s of the scale and the drift k of a stretch.
using LeverUnknowns = Eigen::Matrix<double, 7, 1>;

Vector3 residual(const LeverEquation& e, const LeverUnknowns& x) {
  return e.moved - e.turned * x.head<3>() - x[3] * e.way - x.tail<3>();
}

struct LeverFit {
  LeverUnknowns x;
  Matrix3 covariance;  ///< of c
};

/// Least squares at noise `sigma`, with what is believed of s and k before.
LeverFit fit_of(const std::vector<LeverEquation>& all, double sigma, double way) {
  constexpr double kScale = 10.0;  // of s: any
  constexpr double kDrift = 0.05;  // of k, part of the way
  Eigen::Matrix<double, 7, 7> information = Eigen::Matrix<double, 7, 7>::Zero();
  LeverUnknowns right = LeverUnknowns::Zero();
  Eigen::Matrix<double, 3, 7> row;
  row.rightCols<3>().setIdentity();
  for (const auto& [turned, along, moved, weight] : all) {
    row.leftCols<3>() = turned;
    row.col(3) = along;
    information += weight * row.transpose() * row;
    right += weight * row.transpose() * moved;
  }
  const double square = sigma * sigma;
  information(3, 3) += square / (kScale * kScale);
  information.diagonal().tail<3>().array() += square / (kDrift * kDrift * way * way);
  // Directions of c that nothing tells would have no inverse; they come out as far from sure.
  information.diagonal().head<3>().array() += kRounding * information.topLeftCorner<3, 3>().trace();
  const Eigen::LDLT<Eigen::Matrix<double, 7, 7>> factor(information);
  const Eigen::Matrix<double, 7, 3> first = Eigen::Matrix<double, 7, 3>::Identity();
  return {factor.solve(right), square * factor.solve(first).topRows<3>()};
}

/// Keeps of c what is sure along the axes of its covariance.
void keep_sure(LeverFit& fit, HandEye& out) {
  constexpr double kSure = 3.0;  // deviations
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(fit.covariance);
  Vector3 sure = Vector3::Zero();
  Vector3 variance = Vector3::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vector3 axis = axes.eigenvectors().col(i);
    const double square = std::max(0.0, axes.eigenvalues()[i]);
    const double along = axis.dot(fit.x.head<3>());
    if (along * along < kSure * kSure * square) continue;
    sure += along * axis;
    variance += square * axis.cwiseAbs2();
  }
  fit.x.head<3>() = sure;
  out.body_from_reference.translation = sure;
  out.deviation = variance.cwiseSqrt();
}

/// Squares that a place leaves, the scale chosen for it; no drift: the mean counts, too.
double left_by(const std::vector<LeverEquation>& all, const Vector3& lever, double& scale) {
  double way = 0.0, across = 0.0, out = 0.0;
  for (const LeverEquation& e : all) {
    way += e.weight * e.way.squaredNorm();
    across += e.weight * e.way.dot(e.moved - e.turned * lever);
  }
  scale = way > 0.0 ? across / way : 0.0;
  for (const LeverEquation& e : all) {
    out += e.weight * (e.moved - e.turned * lever - scale * e.way).squaredNorm();
  }
  return out;
}

void fit_lever(std::vector<LeverEquation> all, HandEye& out) {
  constexpr int kRounds = 20;
  constexpr double kHuber = 2.0, kJump = 6.0;  // times the residuals' scale
  constexpr double kMedianOf3d = 1.54;         // of a standard normal vector's length
  const auto count = static_cast<double>(all.size());
  double ways = 0.0;
  for (const LeverEquation& e : all) ways += e.way.squaredNorm() + e.moved.squaredNorm();
  const double way = std::sqrt(ways / count);
  if (!(way > 0.0)) return;
  double sigma = way;
  std::vector<double> lengths(all.size());
  LeverFit fit;
  for (int round = 0; round < kRounds; ++round) {
    fit = fit_of(all, sigma, way);
    for (std::size_t k = 0; k < all.size(); ++k) lengths[k] = residual(all[k], fit.x).norm();
    std::vector<double> sorted = lengths;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    sigma = std::max(*middle / kMedianOf3d, 1e-9 * way);
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k].weight = lengths[k] > kHuber * sigma ? kHuber * sigma / lengths[k] : 1.0;
    }
  }
  keep_sure(fit, out);
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k].weight = lengths[k] > kJump * sigma ? 0.0 : 1.0;
  }
  double scale = 0.0;
  const double before = left_by(all, Vector3::Zero(), scale);
  const double after = left_by(all, out.body_from_reference.translation, scale);
  if (before <= kRounding * ways || after >= before || scale >= 1.0) {
    out.body_from_reference.translation.setZero();  // chance, or an estimate that stands still
    out.deviation.setZero();
    return;
  }
  out.lever_explained = 1.0 - after / before;
  out.body_from_reference.translation /= 1.0 - scale;
  out.deviation /= 1.0 - scale;
}

}  // namespace

std::vector<MotionPair> turning_stretches(const Trajectory& reference,
                                          const Trajectory& estimate,
                                          double turn,
                                          double longest) {
  const double cosine = std::cos(0.5 * turn);
  const auto has_turned = [&](const Trajectory& poses, std::size_t from, std::size_t to) {
    const Rotation& a = poses[from].world_from_body.rotation;
    return std::abs(a.dot(poses[to].world_from_body.rotation)) <= cosine;
  };
  const auto motion = [](const Trajectory& poses, std::size_t from, std::size_t to) {
    return poses[from].world_from_body.inverse() * poses[to].world_from_body;
  };
  std::vector<MotionPair> out;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    const bool is_late = estimate[i].stamp - estimate[begin].stamp > longest;
    const bool turned = has_turned(estimate, begin, i) && has_turned(reference, begin, i);
    if (turned && !is_late)
      out.push_back({motion(reference, begin, i), motion(estimate, begin, i)});
    if (turned || is_late) begin = i;
  }
  return out;
}

HandEye hand_eye(const std::vector<MotionPair>& pairs) {
  HandEye out;
  fit_turn(pairs, out);
  std::vector<LeverEquation> equations;
  equations.reserve(pairs.size());
  for (const auto& [q, z] : pairs) {
    const Vector3 way = out.body_from_reference.rotation * q.translation;
    equations.push_back(
        {z.rotation.toRotationMatrix() - Matrix3::Identity(), way, way - z.translation});
  }
  fit_lever(std::move(equations), out);
  return out;
}

}  // namespace loopbench
