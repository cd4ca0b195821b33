#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "methods/smoothers/penalised/trend.hpp"

namespace loopbench::methods {
namespace {

/// Solves (B + blocks) x = right in place. Scalars of B are multiples of the identity; `blocks` are
/// added to the diagonal and are overwritten. Block elimination; each pivot is symmetrised, because
/// otherwise the asymmetry due to rounding grows from pivot to pivot. O(n).
void solve_block_pentadiagonal(const Pentadiagonal& B,
                               std::vector<Eigen::Matrix3d>& blocks,
                               std::vector<Eigen::Vector3d>& right) {
  using Block = Eigen::Matrix3d;
  const std::size_t n = B.size();
  const auto symmetric = [](const Block& M) -> Block { return 0.5 * (M + M.transpose()); };
  std::vector<Block> factor(n);                // first subdiagonal of L
  Block next = B[0].next * Block::Identity();  // block (i + 1, i)
  for (std::size_t i = 0; i < n; ++i) {
    const Block pivot = blocks[i] + B[i].diagonal * Block::Identity();
    const Block inverse = symmetric(symmetric(pivot).inverse());
    blocks[i] = inverse;
    if (i + 1 == n) break;
    factor[i] = next * inverse;
    blocks[i + 1] -= factor[i] * next.transpose();
    right[i + 1] -= factor[i] * right[i];
    if (i + 2 == n) continue;
    const double second = B[i].second;
    blocks[i + 2] -= second * second * inverse;
    right[i + 2] -= second * (inverse * right[i]);
    next = B[i + 1].next * Block::Identity() - second * factor[i].transpose();
  }
  for (std::size_t i = n; i-- > 0;) {
    Eigen::Vector3d x = right[i];
    if (i + 2 < n) x -= B[i].second * right[i + 2];
    x = (blocks[i] * x).eval();
    if (i + 1 < n) x -= factor[i].transpose() * right[i + 1];
    right[i] = x;
  }
}

/// Returns B x, where scalars of B are multiples of the identity. O(n).
std::vector<Eigen::Vector3d> block_product(const Pentadiagonal& B,
                                           const std::vector<Eigen::Vector3d>& x) {
  std::vector<Eigen::Vector3d> out(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) out[i] = B[i].diagonal * x[i];
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    out[i] += B[i].next * x[i + 1];
    out[i + 1] += B[i].next * x[i];
    if (i + 2 == x.size()) break;
    out[i] += B[i].second * x[i + 2];
    out[i + 2] += B[i].second * x[i];
  }
  return out;
}

using Forces = std::vector<Vector3>;

double force_product(const Forces& a, const Forces& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

Forces force_sum(Forces a, double share, const Forces& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += share * b[i];
  return a;
}

class TrendBarrier {
 public:
  TrendBarrier(const Pentadiagonal& outer, const Forces& bends, double lambda)
      : outer_(outer),
        kinks_(bends),
        square_(lambda * lambda),
        v_(bends.size(), Vector3::Zero()),
        gram_v_(v_) {}

  /// Value of the barrier objective, infinite outside the feasible set.
  double value(double t, const Forces& v, const Forces& gram_v) const {
    double quadratic = 0.0, barrier = 0.0;
    for (std::size_t j = 0; j < v.size(); ++j) {
      const double slack = 1.0 - v[j].squaredNorm() / square_;
      if (!(slack > 0.0)) return std::numeric_limits<double>::infinity();
      quadratic += v[j].dot(0.5 * gram_v[j] - kinks_[j]);
      barrier += std::log(slack);
    }
    return t * quadratic - barrier;
  }

  /// Takes one damped Newton step. Returns twice the predicted decrease, or a negative number when
  /// no step decreases the value.
  double step(double t) {
    const std::size_t n = v_.size();
    std::vector<Matrix3> blocks(n);
    Forces gradient(n), direction(n);
    for (std::size_t j = 0; j < n; ++j) {
      const double slack = square_ - v_[j].squaredNorm();
      const double weight = 2.0 / (t * slack);
      gradient[j] = gram_v_[j] - kinks_[j] + weight * v_[j];
      blocks[j] = weight * Matrix3::Identity() + (2.0 * weight / slack) * v_[j] * v_[j].transpose();
      direction[j] = -gradient[j];
    }
    solve_block_pentadiagonal(outer_, blocks, direction);
    const double predicted = -t * force_product(gradient, direction);
    const Forces gram_direction = block_product(outer_, direction);
    const double value_before = value(t, v_, gram_v_);
    for (double length = std::min(1.0, 0.95 * max_length(direction)); length > 1e-9;
         length *= 0.5) {
      Forces v = force_sum(v_, length, direction),
             gram_v = force_sum(gram_v_, length, gram_direction);
      const double value_after = value(t, v, gram_v);
      if (!(value_after < value_before) ||
          !(value_after <= value_before - 0.1 * length * predicted))
        continue;
      v_ = std::move(v);
      gram_v_ = std::move(gram_v);
      return predicted;
    }
    return -1.0;
  }

  double squares() const { return force_product(v_, gram_v_); }  ///< |D'v|^2

  /// Returns the rows with a slope change. At the optimum either the slack or the multiplier of a
  /// row is zero; a row is selected if its multiplier 1 / slack is relatively larger than its
  /// slack.
  std::vector<std::size_t> kink_rows() const {
    std::vector<double> slack;
    double smallest = 1.0;
    for (const Vector3& v : v_) {
      slack.push_back(1.0 - v.squaredNorm() / square_);
      smallest = std::min(smallest, slack.back());
    }
    std::vector<std::size_t> out;
    for (std::size_t j = 0; j < slack.size(); ++j) {
      if (smallest / slack[j] > slack[j]) out.push_back(j);
    }
    return out;
  }

  Forces forces() && { return std::move(v_); }

 private:
  /// Maximum step length along `direction` that stays feasible.
  double max_length(const Forces& direction) const {
    double out = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < direction.size(); ++j) {
      const double a = direction[j].squaredNorm();
      if (!(a > 0.0)) continue;
      const double b = v_[j].dot(direction[j]), c = square_ - v_[j].squaredNorm();
      out = std::min(out, (std::sqrt(b * b + a * c) - b) / a);
    }
    return out;
  }

  const Pentadiagonal& outer_;
  const Forces& kinks_;
  double square_;
  Forces v_;
  Forces gram_v_;  ///< D D' v
};

}  // namespace

TrendDual solve_trend_dual(const Pentadiagonal& outer,
                           const std::vector<Vector3>& bends,
                           double lambda,
                           double tolerance) {
  constexpr int kMaxSteps = 300;
  constexpr double kFaster = 10.0;  // growth of t from one centre to the next
  constexpr double kCentred = 0.5;  // sufficient predicted decrease per row at a centre
  constexpr double kRounding = 1e-4;
  constexpr double kFinest = 1e-12;  // below this the slacks are rounding errors
  const auto rows = static_cast<double>(bends.size());
  Forces unconstrained = bends;
  PentadiagonalFactor(outer).solve(unconstrained);
  const auto is_feasible = [&](const Vector3& force) { return force.norm() <= lambda; };
  if (std::ranges::all_of(unconstrained, is_feasible))
    return {std::move(unconstrained), {}, 0, true};
  const double threshold = std::max(0.5 * tolerance * tolerance, kFinest);
  const double energy = 0.5 * force_product(unconstrained, bends);  // for the straight line
  TrendBarrier barrier(outer, bends, lambda);
  TrendDual out;
  double t = 2.0 * rows / energy;
  while (!out.converged && out.iterations < kMaxSteps) {
    ++out.iterations;
    const double predicted = barrier.step(t);
    // Bound on the duality gap: two per row over t at a centre.
    const double gap = (2.0 * rows + std::abs(predicted)) / t;
    if (predicted < 0.0) {
      out.converged = gap <= kRounding * barrier.squares();
      break;
    }
    if (predicted > kCentred * rows) continue;
    out.converged = gap <= threshold * barrier.squares();
    t *= kFaster;
  }
  out.bends = barrier.kink_rows();
  out.forces = std::move(barrier).forces();
  return out;
}

}  // namespace loopbench::methods
