#include "metrics/alignment/hand_eye/turn_fit.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

namespace loopbench::metrics {
namespace {

constexpr double kExplains = 0.5;                              // share of the squares, to accept
constexpr double kLeastTurn = 5.0 * std::numbers::pi / 180.0;  // below: a tilt, unobservable in 2-D
constexpr double kSecondAxis = 0.02;                           // of the first singular value
constexpr double kNothing = 1e-18;  // of the squared motion; below it nothing is explained

/// Sums of squared rotations and displacements, each normalised by its own size.
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

/// The rotation by Kabsch's method.
Rotation turn_of(const Eigen::JacobiSVD<Matrix3>& svd) {
  Matrix3 flip = Matrix3::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Rotation turn(Matrix3(svd.matrixU() * flip * svd.matrixV().transpose()));
  if (turn.w() < 0.0) turn.coeffs() *= -1.0;  // the same rotation with w >= 0, as in files
  return turn.normalized();
}

}  // namespace

TurnFit fit_turn(const std::vector<MotionPair>& pairs) {
  const MotionSizes sizes = sizes_of(pairs);
  Matrix3 turns = Matrix3::Zero();
  Matrix3 ways = Matrix3::Zero();
  for (const auto& [q, z] : pairs) {
    turns += log_so3(z.rotation) * log_so3(q.rotation).transpose() / sizes.turns;
    if (sizes.ways > 0.0) ways += z.translation * q.translation.transpose() / sizes.ways;
  }
  constexpr unsigned kWhole = Eigen::ComputeFullU | Eigen::ComputeFullV;
  Eigen::JacobiSVD<Matrix3> svd(turns, kWhole);
  // Displacements also depend on the unknown lever arm: use them only if all rotations share an
  // axis.
  const bool about_one_axis = svd.singularValues()[1] <= kSecondAxis * svd.singularValues()[0];
  if (about_one_axis) svd.compute(turns + ways, kWhole);
  const Rotation turn = turn_of(svd);
  const double before = difference(pairs, sizes, Rotation::Identity());
  if (before <= kNothing || log_so3(turn).norm() < kLeastTurn) return {};
  const double explained = 1.0 - difference(pairs, sizes, turn) / before;
  if (explained < kExplains) return {};
  return {turn, explained};
}

}  // namespace loopbench::metrics
