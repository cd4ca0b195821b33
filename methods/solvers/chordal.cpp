#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <stdexcept>

#include "methods/solvers/initial_values.hpp"

namespace loopbench::methods {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

struct Weights {
  double kappa;  ///< inverse mean variance of rotation [1/rad^2]
  double tau;    ///< inverse mean variance of translation [1/m^2]
};

Weights weights_of(const Edge& edge) {
  const Matrix6 covariance = edge.information.inverse();
  return {3.0 / covariance.bottomRightCorner<3, 3>().trace(),
          3.0 / covariance.topLeftCorner<3, 3>().trace()};
}

/// Normal equations whose unknowns are blocks of `size` rows for keyframes 1, 2, ..; keyframe 0 is
/// fixed.
class System {
 public:
  System(std::size_t keyframes, Eigen::Index size)
      : size_(size),
        rows_(size * static_cast<Eigen::Index>(keyframes - 1)),
        right_(Rows::Zero(rows_, 3)) {}

  /// Adds weight |x_to - M x_from - c|^2, where M is orthogonal (or 1) and x_0 = first.
  template <class Square, class Block>
  void add(const Edge& edge, double weight, const Square& M, const Block& c, const Block& first) {
    const Eigen::Index i = row_of(edge.from);
    const Eigen::Index j = row_of(edge.to);  // never keyframe 0: from < to
    diagonal(j, weight);
    right_.middleRows(j, size_) += weight * c;
    if (i < 0) {
      right_.middleRows(j, size_) += weight * (M * first);
      return;
    }
    diagonal(i, weight);
    right_.middleRows(i, size_) -= weight * (M.transpose() * c);
    for (Eigen::Index r = 0; r < size_; ++r) {
      for (Eigen::Index s = 0; s < size_; ++s)
        entries_.emplace_back(j + r, i + s, -weight * M(r, s));
    }
  }

  Rows solve(const char* what) const {
    Sparse H(rows_, rows_);
    H.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Sparse, Eigen::Lower> factor(H);
    if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0.0)) {
      throw std::runtime_error(std::string("pose graph: the chordal relaxation of ") + what +
                               " is singular; all keyframes must be connected by edges");
    }
    return factor.solve(right_);
  }

 private:
  Eigen::Index row_of(std::size_t keyframe) const {
    return size_ * (static_cast<Eigen::Index>(keyframe) - 1);
  }
  void diagonal(Eigen::Index at, double weight) {
    for (Eigen::Index r = 0; r < size_; ++r) entries_.emplace_back(at + r, at + r, weight);
  }

  Eigen::Index size_;
  Eigen::Index rows_;
  std::vector<Eigen::Triplet<double>> entries_;
  Rows right_;
};

Rotation nearest_rotation(const Matrix3& M) {
  const Eigen::JacobiSVD<Matrix3> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 R = svd.matrixU() * svd.matrixV().transpose();
  if (R.determinant() < 0.0) {
    Matrix3 U = svd.matrixU();
    U.col(2) = -U.col(2);
    R = U * svd.matrixV().transpose();
  }
  return Rotation(R).normalized();
}

template <class Visit>
void for_each_edge(const Problem& problem, Visit visit) {
  for (const Edge& edge : problem.odometry) visit(edge, weights_of(edge));
  for (const Edge& edge : problem.closures) visit(edge, weights_of(edge));
}

}  // namespace

std::vector<ScaledPose> chordal_values(const Problem& problem, double scale_sigma) {
  const std::size_t n = problem.keyframes.size();
  std::vector<ScaledPose> out(n);
  if (n == 0) return out;
  out[0].pose = problem.keyframes[0].world_from_body;
  if (n == 1) return out;

  // R_j = R_i Z is equivalent to R_j' = Z' R_i': the unknowns are the transposes, three rows per
  // keyframe.
  System rotations(n, 3);
  const Matrix3 first = out[0].pose.rotation.toRotationMatrix().transpose();
  for_each_edge(problem, [&](const Edge& edge, const Weights& w) {
    const Matrix3 inverse_rotation = edge.from_from_to.rotation.toRotationMatrix().transpose();
    rotations.add(edge, w.kappa, inverse_rotation, Matrix3(Matrix3::Zero()), first);
  });
  const Rows transposed = rotations.solve("rotations");
  for (std::size_t i = 1; i < n; ++i) {
    const Matrix3 M = transposed.middleRows<3>(3 * static_cast<Eigen::Index>(i - 1)).transpose();
    out[i].pose.rotation = nearest_rotation(M);
  }

  using Row = Eigen::RowVector3d;
  const Eigen::Matrix<double, 1, 1> one = Eigen::Matrix<double, 1, 1>::Identity();
  bool has_scale = false;
  for_each_edge(problem, [&](const Edge& edge, const Weights&) { has_scale |= edge.scale != 1.0; });
  if (has_scale) {
    System scales(n, 1);
    for_each_edge(problem, [&](const Edge& edge, const Weights&) {
      const double weight = 1.0 / (scale_sigma * scale_sigma);
      scales.add(edge, weight, one, Row(std::log(edge.scale), 0.0, 0.0), Row(Row::Zero()));
    });
    const Rows logs = scales.solve("scales");
    for (std::size_t i = 1; i < n; ++i) {
      out[i].scale = std::exp(logs(static_cast<Eigen::Index>(i - 1), 0));
    }
  }

  System translations(n, 1);
  for_each_edge(problem, [&](const Edge& edge, const Weights& w) {
    const ScaledPose& from = out[edge.from];
    const Vector3 step = from.scale * (from.pose.rotation * edge.from_from_to.translation);
    // The deviations of a measurement are in the scale of its first keyframe.
    const double weight = w.tau / (from.scale * from.scale);
    translations.add(
        edge, weight, one, Row(step.transpose()), Row(out[0].pose.translation.transpose()));
  });
  const Rows positions = translations.solve("positions");
  for (std::size_t i = 1; i < n; ++i) {
    out[i].pose.translation = positions.row(static_cast<Eigen::Index>(i - 1)).transpose();
  }
  return out;
}

}  // namespace loopbench::methods
