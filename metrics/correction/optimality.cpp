#include "metrics/correction/optimality.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "metrics/correction/chordal_minimum.hpp"
#include "metrics/correction/graph_cost.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

/// Whether S + eta I on rotations is positive definite.
template <int D>
class ShiftedMatrix {
 public:
  using Matrix = ChordalMatrix<D>;
  ShiftedMatrix(const Matrix& M, const std::vector<typename Matrix::Rotation>& multipliers)
      : M_(M), multipliers_(multipliers), factor_(M.structure()) {}

  bool is_positive(double eta) {
    const auto diagonal = [&](Eigen::Index i) {
      auto block = M_.diagonal(i);
      auto rotation = block.template bottomRightCorner<D, D>();
      rotation -= multipliers_[static_cast<std::size_t>(i)];
      rotation.diagonal().array() += eta;
      // Fixes t_0 = 0: the cost does not depend on it.
      if (i == 0) block(0, 0) *= 2.0;
      return block;
    };
    M_.template assemble<Matrix::kSize>(
        factor_, diagonal, [](const auto& link) { return link.block(); });
    return factor_.factorise();
  }

 private:
  const Matrix& M_;
  const std::vector<typename Matrix::Rotation>& multipliers_;
  methods::BlockCholesky<Matrix::kSize> factor_;
};

/// Smallest share of the cost, up to a factor of 1.6, whose shift makes the matrix positive; 1 if
/// it is above a tenth.
template <class IsPositive>
double least_share(IsPositive is_positive) {
  constexpr double kLeast = 1e-7;
  constexpr double kLargest = 0.1;
  if (is_positive(kLeast)) return kLeast;
  if (!is_positive(kLargest)) return 1.0;
  double below = kLeast;
  double above = kLargest;
  while (above > 1.6 * below) {
    const double middle = std::sqrt(below * above);
    (is_positive(middle) ? above : below) = middle;
  }
  return above;
}

/// Largest rotation between two lists of poses [rad].
template <int D>
double largest_rotation(const typename ChordalMatrix<D>::Poses& X,
                        const typename ChordalMatrix<D>::Poses& Y) {
  double out = 0.0;
  for (Eigen::Index at = 1; at < X.cols(); at += D + 1) {
    const double chord =
        (X.template middleCols<D>(at) - Y.template middleCols<D>(at)).norm() / std::sqrt(8.0);
    out = std::max(out, 2.0 * std::asin(std::min(1.0, chord)));
  }
  return out;
}

template <int D>
Certificate certificate_in(const Problem& problem, const Trajectory& keyframes) {
  const ChordalMatrix<D> M(problem);
  const auto start = ChordalMatrix<D>::columns(keyframes);
  Certificate out;
  out.cost = M.times(start).cost;
  if (!std::isfinite(out.cost)) {
    throw std::runtime_error("the cost of the estimate is not finite");
  }
  const auto X = chordal_minimum<D>(M, start);
  const auto [XM, minimum] = M.times(X);
  out.minimum = minimum;
  out.rotation = largest_rotation<D>(start, X);

  const auto multipliers = M.multipliers(X, XM);
  double traces = 0.0;
  for (const auto& L : multipliers) traces += L.trace();
  // Typical, not worst, backward error of the factorisation.
  double rounding = 0.0;
  for (Eigen::Index i = 0; i < M.size(); ++i) {
    for (int r = 0; r <= D; ++r) {
      rounding += M.diagonal(i)(r, r) * X.col((D + 1) * i + r).squaredNorm();
    }
  }
  rounding *= 4.0 * std::numeric_limits<double>::epsilon();
  if (out.minimum <= rounding) {
    out.minimum = 0.0;
    if (out.cost <= rounding) out.cost = 0.0;
    return out;
  }
  ShiftedMatrix<D> S(M, multipliers);
  const double columns = static_cast<double>(D * M.size());
  const double share =
      least_share([&](double tried) { return S.is_positive(tried * out.minimum / columns); });
  out.lower_bound = std::max(0.0, traces - share * out.minimum - rounding);
  return out;
}

}  // namespace

Certificate certificate(const Problem& problem, const Trajectory& keyframes) {
  if (keyframes.empty() || keyframes.size() != problem.keyframes.size()) {
    throw std::runtime_error("expected one pose per keyframe");
  }
  return problem.planar ? certificate_in<2>(problem, keyframes)
                        : certificate_in<3>(problem, keyframes);
}

std::vector<Score> optimality(const Evaluation& evaluation, const NoOptions&) {
  const Problem& problem = needed(evaluation.context.problem, "edges");
  const Trajectory& poses = needed(evaluation.context.estimate, "keyframes");
  for (const auto* edges : {&problem.odometry, &problem.closures}) {
    require_rigid(*edges);
  }
  if (!problem.anchors.empty()) {
    throw Undefined("the problem has anchors, the certificate is for edges");
  }
  const Certificate proof = certificate(problem, poses);
  const auto gap = [&](double cost) {
    return cost > proof.lower_bound ? 100.0 * (cost - proof.lower_bound) / cost : 0.0;
  };
  const bool is_own_minimum = proof.rotation < 0.5 * M_PI;
  return {single("gap", "minimum", "%", gap(is_own_minimum ? proof.minimum : proof.cost)),
          directed(single("gap", "estimate", "%", gap(proof.cost)), Better::neither),
          directed(single("rotation", "", "deg", kDegrees * proof.rotation), Better::neither)};
}

std::string gap_text(double percent) {
  if (percent < 1e-4) return "globally optimal";
  if (percent >= 100.0) return "not proved";
  return fmt::format("at most {:.3g}", percent);
}

}  // namespace loopbench::metrics
