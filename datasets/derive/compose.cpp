#include "datasets/derive/compose.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace loopbench {
namespace {

Matrix6 inverse(const Matrix6& matrix) {
  const Eigen::LLT<Matrix6> factor(matrix);
  if (factor.info() != Eigen::Success) {
    throw std::invalid_argument("information is not positive definite");
  }
  return factor.solve(Matrix6::Identity());
}

/// Composition of consecutive edges. The uncertainty is stored as covariance, so that it is
/// inverted only once.
struct ComposedEdge {
  Pose step;
  double scale;
  Matrix6 covariance;

  explicit ComposedEdge(const Edge& edge)
      : step(edge.from_from_to), scale(edge.scale), covariance(inverse(edge.information)) {}

  /// Converts translation and covariance of `edge` to the scale of the first pose and appends it.
  void append(const Edge& edge) {
    const Pose next{edge.from_from_to.rotation, scale * edge.from_from_to.translation};
    const Matrix6 transport = adjoint(next.inverse());
    Matrix6 added = inverse(edge.information);
    added.topRows<3>() *= scale;
    added.leftCols<3>() *= scale;
    covariance = transport * covariance * transport.transpose() + added;
    step = normalized(step * next);
    scale *= edge.scale;
  }

  Edge edge(std::size_t from, std::size_t to) const {
    Matrix6 information = inverse(covariance);
    information = 0.5 * (information + information.transpose()).eval();
    return {from, to, step, information, scale};
  }
};

}  // namespace

Edge compose(const Edge& a, const Edge& b) {
  ComposedEdge composed(a);
  composed.append(b);
  return composed.edge(a.from, b.to);
}

std::vector<Edge> bridge(const std::vector<Edge>& chain, const std::vector<std::size_t>& kept) {
  std::vector<Edge> out;
  out.reserve(kept.size());
  for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
    if (kept[k + 1] == kept[k] + 1) {
      out.push_back(chain[kept[k]]);
      out.back().from = k;
      out.back().to = k + 1;
      continue;
    }
    ComposedEdge composed(chain[kept[k]]);
    for (std::size_t i = kept[k] + 1; i < kept[k + 1]; ++i) composed.append(chain[i]);
    out.push_back(composed.edge(k, k + 1));
  }
  return out;
}

}  // namespace loopbench
