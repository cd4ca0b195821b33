#include "methods/smoothers/penalised/trend.hpp"

#include "datasets/core/tridiagonal.hpp"

namespace loopbench {
namespace {

std::vector<double> in_intervals(std::vector<double> stamps, double interval) {
  const double first = stamps.front();
  for (double& stamp : stamps) stamp = (stamp - first) / interval;
  return stamps;
}

double norm(const std::vector<Vector3>& values) {
  double sum = 0.0;
  for (const Vector3& value : values) sum += value.squaredNorm();
  return std::sqrt(sum);
}

std::vector<Vector3> minus(std::vector<Vector3> a, const std::vector<Vector3>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

}  // namespace

Trend::Trend(const std::vector<double>& stamps)
    : interval_((stamps.back() - stamps.front()) / static_cast<double>(stamps.size() - 1)),
      slope_change_({0.0, 1.0, 2.0}) {
  times_ = in_intervals(stamps, interval_);
  slope_change_ = SlopeChange(times_);
}

double Trend::straight_from(const std::vector<Vector3>& y) const {
  std::vector<Vector3> dual = slope_change_.of(y);
  PentadiagonalFactor(slope_change_.outer()).solve(dual);
  double out = 0.0;
  for (const Vector3& value : dual) out = std::max(out, value.norm());
  return out;
}

Trend::Fit Trend::fit(const std::vector<Vector3>& y,
                      double lambda,
                      const Settings& settings,
                      State& state) const {
  const std::size_t count = slope_change_.size();
  if (state.z.empty()) {
    state = {std::vector<Vector3>(count, Vector3::Zero()),
             std::vector<Vector3>(count, Vector3::Zero()),
             lambda};
  }
  constexpr double kRelaxation = 1.6;
  constexpr double kRounding = 1e-12;
  double extent = 0.0;
  for (const Vector3& value : y) extent = std::max(extent, (value - y.front()).norm());

  Fit out;
  out.converged = false;
  PentadiagonalFactor factor(slope_change_.penalty(state.rho));
  while (!out.converged && out.iterations < settings.most) {
    ++out.iterations;
    out.values = y;
    slope_change_.add_transposed(minus(state.z, state.u), state.rho, out.values);
    factor.solve(out.values);
    const std::vector<Vector3> bends = slope_change_.of(out.values);
    const std::vector<Vector3> z_before = state.z;
    for (std::size_t j = 0; j < count; ++j) {
      const Vector3 relaxed = kRelaxation * bends[j] + (1.0 - kRelaxation) * state.z[j];
      const Vector3 free = relaxed + state.u[j];
      const double length = free.norm();
      const double kept = length - lambda / state.rho;
      state.z[j] = kept > 0.0 ? Vector3(kept / length * free) : Vector3(Vector3::Zero());
      state.u[j] = free - state.z[j];
    }
    const double primal = norm(minus(bends, state.z));
    std::vector<Vector3> moved(y.size(), Vector3::Zero()), force = moved;
    slope_change_.add_transposed(minus(state.z, z_before), state.rho, moved);
    slope_change_.add_transposed(state.u, state.rho, force);
    const double dual = norm(moved);
    const double primal_scale = std::max(norm(bends), norm(state.z));
    const double dual_scale = norm(force);
    out.converged = primal <= settings.tolerance * primal_scale + kRounding * extent &&
                    dual <= settings.tolerance * dual_scale + kRounding * extent;
    if (out.iterations % 10 != 0) continue;
    const double balance = primal * dual_scale / (dual * primal_scale);
    if (!(balance > 10.0) && !(balance < 0.1)) continue;
    const double change = balance > 10.0 ? 2.0 : 0.5;
    state.rho *= change;
    for (Vector3& u : state.u) u /= change;
    factor = PentadiagonalFactor(slope_change_.penalty(state.rho));
  }
  for (std::size_t j = 0; j < count; ++j) {
    if (!state.z[j].isZero(0.0)) out.kinks.push_back(j + 1);
  }
  return out;
}

std::vector<Vector3> Trend::refitted(const std::vector<Vector3>& y,
                                     const std::vector<std::size_t>& kinks) const {
  std::vector<std::size_t> knots{0};
  knots.insert(knots.end(), kinks.begin(), kinks.end());
  knots.push_back(y.size() - 1);
  std::vector<TridiagonalRow<double, Vector3>> rows(knots.size(), {0.0, 0.0, 0.0, Vector3::Zero()});
  const auto share = [&](std::size_t piece, std::size_t i) {
    return (times_[i] - times_[knots[piece]]) / (times_[knots[piece + 1]] - times_[knots[piece]]);
  };
  const auto every = [&](auto visit) {
    for (std::size_t piece = 0; piece + 1 < knots.size(); ++piece) {
      const bool last = piece + 2 == knots.size();
      for (std::size_t i = knots[piece]; i < knots[piece + 1] + (last ? 1 : 0); ++i) {
        visit(piece, i, share(piece, i));
      }
    }
  };
  every([&](std::size_t piece, std::size_t i, double u) {
    const Vector3 value = y[i] - y.front();
    const double v = 1.0 - u;
    rows[piece].diagonal += v * v;
    rows[piece].upper += v * u;
    rows[piece].right += v * value;
    rows[piece + 1].diagonal += u * u;
    rows[piece + 1].lower += v * u;
    rows[piece + 1].right += u * value;
  });
  const std::vector<Vector3> at = solve_tridiagonal(rows);
  std::vector<Vector3> out(y.size());
  every([&](std::size_t piece, std::size_t i, double u) {
    out[i] = y.front() + (1.0 - u) * at[piece] + u * at[piece + 1];
  });
  return out;
}

void Trend::refit(const std::vector<Vector3>& y, Fit& fit) const {
  fit.values = refitted(y, fit.kinks);
  const std::vector<Vector3> bends = slope_change_.of(fit.values);
  double largest = 0.0;
  for (const Vector3& bend : bends) largest = std::max(largest, bend.norm());
  std::erase_if(fit.kinks, [&](std::size_t kink) {
    return bends[kink - 1].norm() <= 1e-9 * largest;  // rounding
  });
}

}  // namespace loopbench
