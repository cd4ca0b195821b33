/// Newton's method for the isotropic chordal cost of a pose graph.
#pragma once

#include <array>

#include "metrics/correction/chordal_matrix.hpp"

namespace loopbench::metrics {

/// Steps of a pose: translation in the frame of keyframe 0, then rotation in X_i's own frame.
template <int D>
struct ChordalSteps {
  using Matrix = ChordalMatrix<D>;
  using Poses = typename Matrix::Poses;
  using Rotation = typename Matrix::Rotation;
  static constexpr int kAngles = D * (D - 1) / 2;
  static constexpr int kDof = D + kAngles;
  using Square = Eigen::Matrix<double, kDof, kDof>;

  /// Derivatives R_i E_a of a rotation by its angles.
  static std::array<Rotation, kAngles> derivatives(const Poses& X, Eigen::Index i) {
    const Rotation R = X.template middleCols<D>(Matrix::kSize * i + 1);
    std::array<Rotation, kAngles> out;
    for (int a = 0; a < kAngles; ++a) {
      Rotation E = Rotation::Zero();
      if constexpr (D == 2) {
        E << 0.0, -1.0, 1.0, 0.0;
      } else {
        E = hat(Vector3::Unit(a));
      }
      out[static_cast<std::size_t>(a)] = R * E;
    }
    return out;
  }

  /// Bilinear form of steps of two keyframes that a block of M defines.
  static Square form(const std::array<Rotation, kAngles>& from,
                     const std::array<Rotation, kAngles>& to,
                     const typename Matrix::Block& block) {
    Square out = Square::Zero();
    out.template topLeftCorner<D, D>().diagonal().setConstant(block(0, 0));
    for (int a = 0; a < kAngles; ++a) {
      const Rotation& A = from[static_cast<std::size_t>(a)];
      const Rotation AB = A * block.template bottomRightCorner<D, D>();
      out.template block<1, D>(D + a, 0) = (A * block.template block<D, 1>(1, 0)).transpose();
      out.template block<D, 1>(0, D + a) =
          to[static_cast<std::size_t>(a)] * block.template block<1, D>(0, 1).transpose();
      for (int b = 0; b < kAngles; ++b) {
        out(D + a, D + b) = AB.cwiseProduct(to[static_cast<std::size_t>(b)]).sum();
      }
    }
    return out;
  }

  static Rotation exp(const Eigen::Matrix<double, kAngles, 1>& angles) {
    if constexpr (D == 2) {
      return Eigen::Rotation2Dd(angles[0]).toRotationMatrix();
    } else {
      return exp_so3(angles).toRotationMatrix();
    }
  }

  static Poses moved(const Matrix& M, const Poses& X, const Eigen::MatrixXd& step, double share) {
    Poses out = X;
    for (Eigen::Index i = 0; i < M.size(); ++i) {
      const Eigen::Index at = kDof * i;
      out.col(Matrix::kSize * i) += share * step.col(0).template segment<D>(at);
      auto R = out.template middleCols<D>(Matrix::kSize * i + 1);
      R = (R * exp(share * step.col(0).template segment<kAngles>(at + D))).eval();
    }
    return out;
  }

  /// Negative gradient, 0 for keyframe 0.
  static Eigen::VectorXd descent(const Matrix& M, const Poses& X, const Poses& XM) {
    Eigen::VectorXd out(kDof * M.size());
    for (Eigen::Index i = 0; i < M.size(); ++i) {
      const Eigen::Index at = kDof * i;
      out.template segment<D>(at) = -XM.col(Matrix::kSize * i);
      const auto by_angle = derivatives(X, i);
      for (int a = 0; a < kAngles; ++a) {
        out[at + D + a] = -by_angle[static_cast<std::size_t>(a)]
                               .cwiseProduct(XM.template middleCols<D>(Matrix::kSize * i + 1))
                               .sum();
      }
      if (i == 0) out.template segment<kDof>(at).setZero();
    }
    return out;
  }

  /// Factorises the Hessian with the curvature of the rotations (Newton) or, if there are no
  /// multipliers, without (Gauss-Newton). False: it is not positive definite.
  static bool factorise(methods::BlockCholesky<kDof>& factor,
                        const Matrix& M,
                        const Poses& X,
                        const std::vector<Rotation>& multipliers) {
    std::vector<std::array<Rotation, kAngles>> by_angle;
    by_angle.reserve(static_cast<std::size_t>(M.size()));
    for (Eigen::Index i = 0; i < M.size(); ++i) by_angle.push_back(derivatives(X, i));
    const auto of = [&](Eigen::Index i) -> const auto& {
      return by_angle[static_cast<std::size_t>(i)];
    };
    const auto diagonal = [&](Eigen::Index i) -> Square {
      if (i == 0) return Square::Identity();
      typename Matrix::Block block = M.diagonal(i);
      if (!multipliers.empty()) {
        block.template bottomRightCorner<D, D>() -= multipliers[static_cast<std::size_t>(i)];
      }
      return form(of(i), of(i), block);
    };
    M.template assemble<kDof>(factor, diagonal, [&](const auto& link) -> Square {
      if (link.from == 0 || link.to == 0) return Square::Zero();
      return form(of(link.from), of(link.to), link.block());
    });
    return factor.factorise();
  }
};

/// Returns the local minimum that Newton's method reaches from X; where the Hessian is not positive
/// definite, a Gauss-Newton step is taken. A factor is used again as long as the predicted decrease
/// shrinks tenfold. Steps are halved until the cost does not rise. Keyframe 0 is fixed.
template <int D>
typename ChordalMatrix<D>::Poses chordal_minimum(const ChordalMatrix<D>& M,
                                                 typename ChordalMatrix<D>::Poses X) {
  using Steps = ChordalSteps<D>;
  constexpr int kMaxIterations = 50;
  constexpr double kConverged = 1e-15;  // predicted relative decrease of the cost
  constexpr double kRounding = 1e-9;    // below it the decrease cannot be measured
  methods::BlockCholesky<Steps::kDof> factor(M.structure());
  auto [XM, cost] = M.times(X);
  double last_predicted = std::numeric_limits<double>::infinity();
  bool is_factor_good = false;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const bool is_new = !is_factor_good;
    if (is_new && !Steps::factorise(factor, M, X, M.multipliers(X, XM)) &&
        !Steps::factorise(factor, M, X, {})) {
      return X;
    }
    const Eigen::MatrixXd right = Steps::descent(M, X, XM);
    Eigen::MatrixXd step = right;
    factor.solve(step);
    const double predicted = step.col(0).dot(right.col(0));
    if (!(predicted > kConverged * cost)) return Steps::moved(M, X, step, 1.0);
    is_factor_good = predicted < 0.1 * last_predicted;
    const bool is_rounding = predicted < kRounding * cost;
    if (is_rounding && !(predicted < 0.5 * last_predicted)) {
      if (is_new) return X;
      continue;
    }
    last_predicted = predicted;
    bool is_moved = false;
    for (double share = 1.0; share > 1e-3 && !is_moved; share *= 0.5) {
      auto next = Steps::moved(M, X, step, share);
      auto product = M.times(next);
      is_moved = product.cost <= cost || is_rounding;
      if (!is_moved) continue;
      X = std::move(next), XM = std::move(product.XM), cost = product.cost;
      is_factor_good = is_factor_good && share == 1.0;
    }
    if (!is_moved && is_new) return X;
    is_factor_good = is_factor_good && is_moved;
  }
  return X;
}

}  // namespace loopbench::metrics
