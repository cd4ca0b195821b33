#include "methods/smoothers/penalised/trend_dual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "methods/smoothers/penalised/block_pentadiagonal.hpp"

namespace loopbench {
namespace {

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
        bends_(bends),
        square_(lambda * lambda),
        v_(bends.size(), Vector3::Zero()),
        pushed_(v_) {}

  /// Infinite outside.
  double value(double t, const Forces& v, const Forces& pushed) const {
    double quadratic = 0.0, barrier = 0.0;
    for (std::size_t j = 0; j < v.size(); ++j) {
      const double slack = 1.0 - v[j].squaredNorm() / square_;
      if (!(slack > 0.0)) return std::numeric_limits<double>::infinity();
      quadratic += v[j].dot(0.5 * pushed[j] - bends_[j]);
      barrier += std::log(slack);
    }
    return t * quadratic - barrier;
  }

  /// One damped Newton step. What it promised to lower the value by, doubled; negative when nothing
  /// could be lowered.
  double step(double t) {
    const std::size_t n = v_.size();
    std::vector<Matrix3> blocks(n);
    Forces gradient(n), way(n);
    for (std::size_t j = 0; j < n; ++j) {
      const double slack = square_ - v_[j].squaredNorm();
      const double pull = 2.0 / (t * slack);
      gradient[j] = pushed_[j] - bends_[j] + pull * v_[j];
      blocks[j] = pull * Matrix3::Identity() + (2.0 * pull / slack) * v_[j] * v_[j].transpose();
      way[j] = -gradient[j];
    }
    solve_block_pentadiagonal(outer_, blocks, way);
    const double promised = -t * force_product(gradient, way);
    const Forces way_pushed = block_product(outer_, way);
    const double now = value(t, v_, pushed_);
    for (double length = std::min(1.0, 0.95 * room(way)); length > 1e-9; length *= 0.5) {
      Forces v = force_sum(v_, length, way), pushed = force_sum(pushed_, length, way_pushed);
      const double then = value(t, v, pushed);
      if (!(then < now) || !(then <= now - 0.1 * length * promised)) continue;
      v_ = std::move(v);
      pushed_ = std::move(pushed);
      return promised;
    }
    return -1.0;
  }

  double squares() const { return force_product(v_, pushed_); }  ///< |D'v|^2

  /// Either a force or a bend has room at the optimum, never both: rows where the multiplier
  /// 1 / slack stands out more than the slack itself does.
  std::vector<std::size_t> bent() const {
    std::vector<double> slack;
    double least = 1.0;
    for (const Vector3& v : v_) {
      slack.push_back(1.0 - v.squaredNorm() / square_);
      least = std::min(least, slack.back());
    }
    std::vector<std::size_t> out;
    for (std::size_t j = 0; j < slack.size(); ++j) {
      if (least / slack[j] > slack[j]) out.push_back(j);
    }
    return out;
  }

  Forces forces() && { return std::move(v_); }

 private:
  /// How far along `way` the balls reach.
  double room(const Forces& way) const {
    double out = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < way.size(); ++j) {
      const double a = way[j].squaredNorm();
      if (!(a > 0.0)) continue;
      const double b = v_[j].dot(way[j]), c = square_ - v_[j].squaredNorm();
      out = std::min(out, (std::sqrt(b * b + a * c) - b) / a);
    }
    return out;
  }

  const Pentadiagonal& outer_;
  const Forces& bends_;
  double square_;
  Forces v_;
  Forces pushed_;  ///< D D' v
};

}  // namespace

TrendDual solve_trend_dual(const Pentadiagonal& outer,
                           const std::vector<Vector3>& bends,
                           double lambda,
                           double tolerance,
                           int most) {
  constexpr double kFaster = 10.0;  // t, from one centre to the next
  constexpr double kSettled = 0.5;  // promised a row, as near a centre as is needed
  constexpr double kRounding = 1e-4;
  constexpr double kFinest = 1e-12;  // below it slacks are rounding
  const auto rows = static_cast<double>(bends.size());
  Forces free = bends;
  PentadiagonalFactor(outer).solve(free);
  const auto inside = [&](const Vector3& force) { return force.norm() <= lambda; };
  if (std::ranges::all_of(free, inside)) return {std::move(free), {}, 0, true};
  const double small = std::max(0.5 * tolerance * tolerance, kFinest);
  const double energy = 0.5 * force_product(free, bends);  // of the straight line
  TrendBarrier barrier(outer, bends, lambda);
  TrendDual out;
  double t = 2.0 * rows / energy;
  while (!out.converged && out.iterations < most) {
    ++out.iterations;
    const double promised = barrier.step(t);
    // How far the objective is from its least: at a centre, two a row, over t.
    const double above = (2.0 * rows + std::abs(promised)) / t;
    if (promised < 0.0) {
      out.converged = above <= kRounding * barrier.squares();
      break;
    }
    if (promised > kSettled * rows) continue;
    out.converged = above <= small * barrier.squares();
    t *= kFaster;
  }
  out.bends = barrier.bent();
  out.forces = std::move(barrier).forces();
  return out;
}

}  // namespace loopbench
