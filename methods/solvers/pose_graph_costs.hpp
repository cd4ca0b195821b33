/// Cost functions of edges and anchors for Ceres.
#pragma once

#include <ceres/ceres.h>

#include "methods/solvers/anchor_residual.hpp"
#include "methods/solvers/edge_residual.hpp"

namespace loopbench::methods {

/// X * Exp(d). Cost functions write their derivative with respect to d into the first columns of
/// the ambient Jacobian, so this Jacobian is a projection and no derivatives of quaternion entries
/// are needed.
template <class G>
class RightPerturbation final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return G::kSize; }
  int TangentSize() const override { return G::kDof; }
  bool Plus(const double* x, const double* d, double* out) const override {
    const Eigen::Map<const typename G::Tangent> twist(d);
    G::write(G::compose(G::read(x), G::exp(twist)), out);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, G::kSize, G::kDof, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* d) const override {
    Eigen::Map<typename G::Tangent> twist(d);
    twist = G::log(G::compose(G::inverse(G::read(x)), G::read(y)));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, G::kDof, G::kSize, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
};

/// Residual root * e with Omega = root' root.
template <class G>
class EdgeCost final : public ceres::SizedCostFunction<G::kDof, G::kSize, G::kSize> {
 public:
  EdgeCost(const Edge& edge, double weight, double scale_sigma)
      : back_(G::inverse(G::from(measured(edge)))),
        root_(information_root<G>(edge, weight, scale_sigma)) {}

  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    Eigen::Map<typename G::Tangent> out(residual);
    const auto from = G::read(x[0]);
    const auto to = G::read(x[1]);
    if (jacobians == nullptr) {
      out = root_ * group_edge_error<G>(back_, G::compose(G::inverse(from), to));
      return true;
    }
    const EdgeResidual<G> at = edge_residual<G>(back_, from, to);
    out = root_ * at.error;
    fill(jacobians[0], at.by_from);
    fill(jacobians[1], at.by_to);
    return true;
  }

 private:
  void fill(double* block, const typename G::Square& J) const {
    if (block == nullptr) return;
    Eigen::Map<Eigen::Matrix<double, G::kDof, G::kSize, Eigen::RowMajor>> map(block);
    map.setZero();
    map.template leftCols<G::kDof>() = root_ * J;
  }

  typename G::Element back_;
  typename G::Square root_;
};

/// Residual root * e with C^-1 = root' root.
template <class G>
class AnchorCost final : public ceres::SizedCostFunction<3, G::kSize> {
 public:
  explicit AnchorCost(const Anchor& anchor)
      : anchor_(anchor), root_(anchor.covariance.inverse().llt().matrixU()) {}

  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    const AnchorResidual at = anchor_residual(anchor_, G::to_scaled_pose(G::read(x[0])).pose);
    Eigen::Map<Vector3> out(residual);
    out = root_ * at.error;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, 3, G::kSize, Eigen::RowMajor>> map(jacobians[0]);
    map.setZero();
    constexpr int kPlane[] = {0, 1, 5};
    for (int i = 0; i < G::kDof; ++i) {
      map.col(i) = root_ * at.by_pose.col(G::kDof == 3 ? kPlane[i] : i);
    }
    return true;
  }

 private:
  Anchor anchor_;
  Matrix3 root_;
};

}  // namespace loopbench::methods
