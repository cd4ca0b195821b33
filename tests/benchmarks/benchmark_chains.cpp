// Maximum likelihood on chains with nine loops, as in KITTI 00: the closed form against sparse
// least squares, from a thousand keyframes to a million; and the ledger of many closures.
#include <algorithm>
#include <cmath>
#include <random>

#include "methods/correctors/closure_ledger.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/benchmarks/peak_memory.hpp"
#include "tests/benchmarks/sizes.hpp"

namespace loopbench {

using namespace methods;

namespace {

/// Ten rounds of a car for any n, with the drift of one KITTI run: at most 1 % of the distance
/// travelled and 0.1 rad. Loops of a round and a bit.
Problem chain_with(std::size_t n, std::size_t loops) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double steps = static_cast<double>(n);
  const double length = 3700.0 / steps;  // per step [m]
  const double sigma_t = 2.0 / std::sqrt(steps);
  const double sigma_r = 0.1 / std::sqrt(steps);
  const auto noise = [&](double t, double r) {
    Twist out;
    for (int i = 0; i < 6; ++i) out[i] = (i < 3 ? t : r) * unit(random);
    return out;
  };
  const auto information = [](double t, double r) {
    Matrix6 out = Matrix6::Zero();
    out.diagonal().head<3>().setConstant(1.0 / (t * t));
    out.diagonal().tail<3>().setConstant(1.0 / (r * r));
    return out;
  };
  const Pose step = exp_se3(twist({length, 0.0, 0.0}, {0.0, 0.0, 20.0 * M_PI / steps}));
  Problem out;
  std::vector<Pose> truth(n);
  for (std::size_t i = 0; i < n; ++i) {
    Pose pose;
    if (i > 0) {
      truth[i] = normalized(truth[i - 1] * step);
      const Pose measured = normalized(step * exp_se3(noise(sigma_t, sigma_r)));
      out.odometry.push_back({i - 1, i, measured, information(sigma_t, sigma_r)});
      pose = normalized(out.keyframes.back().world_from_body * measured);
    }
    out.keyframes.push_back({0.1 * static_cast<double>(i), pose});
  }
  for (std::size_t k = 0; k < loops; ++k) {
    const std::size_t from = k * (9 * n / 10) / loops;
    const std::size_t to = std::min(from + n / 10 + n / 50, n - 1);
    const Pose seen = truth[from].inverse() * truth[to] * exp_se3(noise(0.1, 0.01));
    out.closures.push_back({from, to, normalized(seen), information(0.1, 0.01)});
  }
  return out;
}

/// One per round.
Problem chain(std::size_t n) { return chain_with(n, 9); }

/// A closure at each tenth keyframe, one of them false if `is_false`.
template <bool is_false>
Problem many_closures(std::size_t n) {
  Problem out = chain_with(n, n / 10);
  if (is_false) out.closures[n / 20].from_from_to.translation.x() += 20.0;
  return out;
}

template <bool is_false>
void ledger(std::size_t n, benchmark::State& state) {
  const Problem& problem = test::kept<many_closures<is_false>>(n);
  for (auto _ : state) benchmark::DoNotOptimize(closure_ledger(problem));
}

template <bool is_false>
void solve(std::size_t n, benchmark::State& state) {
  const Problem& problem = test::kept<many_closures<is_false>>(n);
  const Dual dual({.max_closures = 1000});
  Report report;
  for (auto _ : state) benchmark::DoNotOptimize(dual.correct(problem, report));
}

template <class Method>
void correct(std::size_t n, benchmark::State& state) {
  const Problem& problem = test::kept<chain>(n);
  const Method method({});
  double iterations = 0.0;
  const double before = test::reset_peak();
  for (auto _ : state) {
    Report report;
    benchmark::DoNotOptimize(method.correct(problem, report));
    for (const Count& count : report.counts) {
      if (count.name == "iterations") iterations = count.value;
    }
  }
  state.counters["iterations"] = iterations;
  state.counters["bytes a keyframe"] =
      (test::peak_megabytes() - before) * 1024.0 * 1024.0 / static_cast<double>(n);
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  test::register_sizes("dual", 1'000'000, correct<Dual>);
  test::register_sizes("pose_graph", 1'000'000, correct<PoseGraphOptimizer>);
  test::register_sizes("ledger", 10'000, ledger<false>);
  test::register_sizes("dual, as many closures", 10'000, solve<false>);
  test::register_sizes("ledger, one closure is false", 10'000, ledger<true>);
  test::register_sizes("dual, one closure is false", 10'000, solve<true>);
  return test::run_benchmarks(argc, argv);
}
