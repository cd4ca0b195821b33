#include "methods/correctors/pose_graph.hpp"

#include <algorithm>
#include <cmath>

#include "methods/correctors/chain.hpp"

namespace loopbench {
namespace {

using Gnc = PoseGraphOptimizer::Gnc;

std::vector<Pose> initial(const Problem& problem, PoseGraphOptimizer::Start start) {
  std::vector<Pose> out;
  out.reserve(problem.keyframes.size());
  for (const StampedPose& k : problem.keyframes) out.push_back(k.world_from_body);
  if (start == PoseGraphOptimizer::Start::odometry) {
    for (const Edge& edge : problem.odometry) {
      out[edge.to] = normalized(out[edge.from] * edge.from_from_to);
    }
  }
  return out;
}

std::vector<double> squared_errors(const Problem& problem, const std::vector<Pose>& poses) {
  std::vector<double> out;
  for (const Edge& loop : problem.closures) {
    const Twist e = edge_error(loop, poses[loop.from], poses[loop.to]);
    out.push_back(e.dot(loop.information * e));
  }
  return out;
}

/// A closure's weight at convexity mu (Yang et al., equations 14 and 12).
double weight(Gnc kind, double squared, double c2, double mu) {
  if (kind == Gnc::gm) {
    const double w = mu * c2 / (squared + mu * c2);
    return w * w;
  }
  if (squared <= mu / (mu + 1.0) * c2) return 1.0;
  if (squared >= (mu + 1.0) / mu * c2) return 0.0;
  return std::sqrt(c2 * mu * (mu + 1.0) / squared) - mu;
}

}  // namespace

std::optional<std::string> PoseGraphOptimizer::declines(const Problem& problem) const {
  if (problem.closures.empty()) return "no loop closure to spread";
  if (const std::string fault = chain_fault(problem); !fault.empty()) return fault;
  return std::nullopt;
}

Trajectory PoseGraphOptimizer::correct(const Problem& problem, Report& report) const {
  std::vector<Pose> poses = initial(problem, options_.start);
  const PoseGraphSettings settings{
      options_.loss, options_.loss_width, options_.max_iterations, options_.tolerance};
  std::vector<double> weights(problem.closures.size(), 1.0);
  const auto solve = [&] {
    return solve_pose_graph(poses, problem.odometry, problem.closures, weights, settings);
  };
  PoseGraphSummary summary = solve();
  int iterations = summary.iterations;
  const double before = summary.cost_before;

  if (options_.gnc != Gnc::off) {
    const double c2 = options_.inlier_chi2;
    std::vector<double> squared = squared_errors(problem, poses);
    const double worst = *std::ranges::max_element(squared);
    const bool is_tls = options_.gnc == Gnc::tls;
    // Truncated least squares sharpens as mu grows, Geman-McClure as it shrinks to 1.
    double mu = is_tls ? c2 / (2.0 * worst - c2) : 2.0 * worst / c2;
    int rounds = 0;
    constexpr int kMostRounds = 100;
    bool settled = worst <= c2;
    while (!settled && rounds < kMostRounds) {
      for (std::size_t k = 0; k < weights.size(); ++k) {
        weights[k] = weight(options_.gnc, squared[k], c2, mu);
      }
      summary = solve();
      iterations += summary.iterations;
      ++rounds;
      squared = squared_errors(problem, poses);
      settled = is_tls ? std::ranges::all_of(weights, [](double w) { return w == 0.0 || w == 1.0; })
                       : mu <= 1.0;
      mu = is_tls ? 1.4 * mu : std::max(1.0, mu / 1.4);
    }
    report.count("gnc_rounds", rounds);
    report.count(
        "closures_kept",
        static_cast<double>(std::ranges::count_if(squared, [&](double s) { return s <= c2; })));
  }
  report.count("iterations", iterations);
  report.count("cost_before", before);
  report.count("cost", summary.cost);

  Trajectory out = problem.keyframes;
  for (std::size_t i = 0; i < out.size(); ++i) out[i].world_from_body = poses[i];
  return out;
}

}  // namespace loopbench
