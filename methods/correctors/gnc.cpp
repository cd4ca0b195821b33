#include "methods/correctors/gnc.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/consistency.hpp"
#include "methods/solvers/initial_values.hpp"

namespace loopbench::methods {
namespace {

/// Relative cost below which a solution replaces an earlier one; rough solutions of the same
/// minimum differ by less. [-]
constexpr double kSameMinimum = 0.999;

/// Returns the indices of the consistent closures, or none when the check is not applicable.
std::vector<std::size_t> indices_of_consistent(const Problem& problem) {
  if (problem.closures.size() > static_cast<std::size_t>(kMaxComparedClosures)) {
    return {};
  }
  if (!why_no_chain(problem).empty() || has_scale_drift(problem)) return {};
  std::vector<std::size_t> found = consistent_closures(problem).kept;
  if (found.size() < 2) found.clear();
  return found;
}

/// Weight of a closure with squared error `squared` at convexity mu. c2 is the largest squared
/// error of an inlier (Yang et al., RA-L 2020, equation 14).
double gnc_weight(double squared, double c2, double mu) {
  if (squared <= mu / (mu + 1.0) * c2) return 1.0;
  if (squared >= (mu + 1.0) / mu * c2) return 0.0;
  return std::sqrt(c2 * mu * (mu + 1.0) / squared) - mu;
}

struct GncResult {
  std::vector<double> weights;
  int rounds = 0;
};

/// Alternates between weights and solutions. `squared` holds the squared errors of the closures at
/// the initial solution. Without `mu`, that solution uses all closures with weight 1 and the
/// initial convexity is computed from the largest error; with `mu`, the solution is more reliable
/// and the schedule starts at that convexity. `solve` takes weights and returns the squared errors
/// at their solution. Ends when every weight is 0 or 1, at most after 100 rounds.
GncResult graduate_weights(
    double c2,
    std::vector<double> squared,
    std::optional<double> mu,
    const std::function<std::vector<double>(const std::vector<double>&)>& solve) {
  GncResult out;
  out.weights.assign(squared.size(), 1.0);
  const double largest = *std::ranges::max_element(squared);
  if (largest <= c2) return out;
  double convexity = mu.value_or(c2 / (2.0 * largest - c2));
  constexpr int kMaxRounds = 100;
  for (bool converged = false; !converged && out.rounds < kMaxRounds; ++out.rounds) {
    for (std::size_t k = 0; k < squared.size(); ++k) {
      out.weights[k] = gnc_weight(squared[k], c2, convexity);
    }
    squared = solve(out.weights);
    converged = std::ranges::all_of(out.weights, [](double w) { return w == 0.0 || w == 1.0; });
    convexity = 1.4 * convexity;  // less convex
  }
  return out;
}

struct GncStartPoint {
  std::vector<ScaledPose> poses;
  std::vector<double> weights;
  std::optional<double> mu;
};

class GncRuns {
 public:
  explicit GncRuns(const GncProblem& of) : of_(of) {}

  /// The solution with the lowest cost so far.
  const GncSolution& best() const { return best_; }

  void from_consistent(const std::vector<std::size_t>& consistent) {
    Problem subset{of_.problem.keyframes, of_.problem.odometry, {}, {}, of_.problem.planar};
    std::vector<double> weights(of_.problem.closures.size(), 0.0);
    for (const std::size_t k : consistent) {
      subset.closures.push_back(of_.problem.closures[k]);
      weights[k] = 1.0;
    }
    // Skips the convex stages, because their purpose is to find initial values like these.
    run({of_.initial(subset), std::move(weights), 1.0});
  }

  void from_all(std::vector<ScaledPose> poses) {
    run({std::move(poses), std::vector<double>(of_.problem.closures.size(), 1.0), std::nullopt});
  }

  /// Odometry alone, at which all closures are rejected.
  void without_closures() {
    GncSolution out{tree_values(of_.problem), std::vector<double>(of_.problem.closures.size())};
    const double cost = cost_of(out.poses);
    if (cost >= kSameMinimum * lowest_cost_) return;
    out.iterations = best_.iterations;
    out.cost_before = best_.cost_before;
    best_ = std::move(out);
    lowest_cost_ = cost;
  }

 private:
  void run(GncStartPoint start) {
    // Until the end only the weights are needed, and rough solutions are sufficient for them.
    PoseGraphSettings rough = of_.settings;
    rough.max_iterations = std::min(rough.max_iterations, 30);
    rough.tolerance = std::max(rough.tolerance, 1e-6);
    GncSolution out{start.poses, start.weights};
    const auto solve = [&] {
      const PoseGraphSummary summary = solve_pose_graph(
          out.poses, {of_.problem.odometry, of_.problem.closures, out.weights}, rough, of_.cache);
      out.iterations += summary.iterations;
      return summary.cost_before;
    };
    const auto squared = [&] {
      return squared_errors(out.poses, of_.problem.closures, of_.settings);
    };
    out.cost_before = solve();
    if (start.mu) start.poses = out.poses;
    const auto solved_with = [&](const std::vector<double>& weights) {
      out.weights = weights;
      // False closures can wind the chain up, and the solver may not find the minimum from there.
      out.poses = start.poses;
      solve();
      return squared();
    };
    const GncResult result = graduate_weights(of_.inlier_chi2, squared(), start.mu, solved_with);
    out.weights = result.weights;
    out.rounds = result.rounds;
    const double cost = cost_of(out.poses);
    // Restart from the initial poses: at a rough solution the final solver stops too early, because
    // its first step hardly lowers the cost.
    out.poses = std::move(start.poses);
    const int iterations = best_.iterations + out.iterations;
    if (cost < kSameMinimum * lowest_cost_) {
      best_ = std::move(out);
      lowest_cost_ = cost;
    }
    best_.iterations = iterations;
  }

  double cost_of(const std::vector<ScaledPose>& poses) const {
    const std::vector<double> odometry = squared_errors(poses, of_.problem.odometry, of_.settings);
    double sum = std::accumulate(odometry.begin(), odometry.end(), 0.0);
    const double bound = of_.inlier_chi2;
    for (const double x : squared_errors(poses, of_.problem.closures, of_.settings)) {
      sum += std::min(x, bound);
    }
    return sum;
  }

  const GncProblem& of_;
  GncSolution best_;
  double lowest_cost_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::size_t kept_count(const std::vector<double>& weights) {
  return static_cast<std::size_t>(
      std::ranges::count_if(weights, [](double weight) { return weight > 0.5; }));
}

std::vector<std::size_t> rejected_closures(const std::vector<double>& weights) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!(weights[k] > 0.5)) out.push_back(k);
  }
  return out;
}

GncSolution solve_gnc(const GncProblem& of, Report& report) {
  const std::size_t closures = of.problem.closures.size();
  const std::vector<std::size_t> consistent =
      report.time("check", [&] { return indices_of_consistent(of.problem); });
  const bool is_unchecked = closures <= 2 && consistent.empty() && why_no_chain(of.problem).empty();
  const GncSolution out = report.time("graduate", [&] {
    GncRuns runs(of);
    if (!consistent.empty()) runs.from_consistent(consistent);
    if (2 * kept_count(runs.best().weights) < closures || consistent.empty()) {
      runs.from_all(of.initial(of.problem));
    }
    const bool rejects = kept_count(runs.best().weights) < closures;
    if (consistent.empty() && rejects) runs.from_all(tree_values(of.problem));
    if (is_unchecked) runs.without_closures();
    return runs.best();
  });
  if (is_unchecked && kept_count(out.weights) == 1) report.notes.emplace_back(kOneClosure);
  if (2 * kept_count(out.weights) < closures) {
    report.notes.push_back(
        "graduated non-convexity kept " + std::to_string(kept_count(out.weights)) + " of " +
        std::to_string(closures) +
        " closures: either the others are false or the odometry covariances are too small");
  }
  return out;
}

}  // namespace loopbench::methods
