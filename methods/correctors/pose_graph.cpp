#include "methods/correctors/pose_graph.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "methods/correctors/anchors.hpp"
#include "methods/correctors/chain.hpp"
#include "methods/correctors/chi_squared.hpp"
#include "methods/correctors/few_loops.hpp"
#include "methods/correctors/gnc.hpp"
#include "methods/correctors/gravity.hpp"
#include "methods/correctors/stiffness.hpp"
#include "methods/solvers/graph_covariance.hpp"
#include "methods/solvers/initial_values.hpp"
#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench::methods {
namespace {

using Poses = PoseGraphOptimizer::Poses;
using Start = PoseGraphOptimizer::Start;

/// Planar problems have no roll and pitch.
bool is_level(const Problem& problem, const PoseGraphOptimizer::Options& options) {
  return options.gravity && !problem.planar;
}

Group group_of(const Problem& problem, Poses requested, bool has_drift) {
  if (requested == Poses::se2) return Group::se2;
  if (requested == Poses::se3) return Group::se3;
  if (requested == Poses::sim3 || has_drift) return Group::sim3;
  return problem.planar ? Group::se2 : Group::se3;
}

std::size_t dimensions(Group group) {
  if (group == Group::se2) return 3;
  if (group == Group::level) return 4;
  return group == Group::se3 ? 6 : 7;
}

PoseGraphSettings settings_of(const Problem& problem,
                              const PoseGraphOptimizer::Options& options,
                              const UsedAnchors& used) {
  const Group group =
      used.level ? Group::level : group_of(problem, options.group, has_scale_drift(problem));
  const double width = options.loss == RobustLoss::dcs ? inlier_chi2(dimensions(group)) : 1.0;
  return {.group = group,
          .scale_sigma = options.scale_sigma,
          .loss = options.loss,
          .loss_width = options.loss_width.value_or(width),
          .max_iterations = options.max_iterations,
          .tolerance = options.tolerance,
          .anchors = used.anchors,
          .is_first_free = used.is_first_free};
}

std::vector<ScaledPose> initial(const Problem& problem,
                                const PoseGraphOptimizer::Options& options,
                                EliminationCache& cache) {
  if (options.start == Start::chordal) return chordal_values(problem, options.scale_sigma, cache);
  if (options.start == Start::odometry) return tree_values(problem);
  // Keyframes have no scale: it is that of the tree.
  std::vector<ScaledPose> out = has_scale_drift(problem)
                                    ? tree_values(problem)
                                    : std::vector<ScaledPose>(problem.keyframes.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i].pose = problem.keyframes[i].world_from_body;
  return out;
}

/// One optimisation: its problem, and the state that its solves share.
struct Optimisation {
  const Problem& problem;
  const PoseGraphOptimizer::Options& options;
  PoseGraphSettings settings;
  std::vector<double> weights;  ///< of the closures
  EliminationCache cache = {};
  std::vector<ScaledPose> poses = {};
  int iterations = 0;

  /// Minimises from `poses`.
  PoseGraphSummary solve(const PoseGraphSettings& by) {
    const PoseGraphSummary out =
        solve_pose_graph(poses, {problem.odometry, problem.closures, weights}, by, cache);
    iterations += out.iterations;
    return out;
  }

  /// Computes the initial values, and moves them to the anchors if the first pose is free.
  void set_initial_poses(const UsedAnchors& used, Report& report) {
    poses = report.time("initial values", [&] { return initial(problem, options, cache); });
    if (!used.is_first_free) return;
    Trajectory keyframes = problem.keyframes;
    for (std::size_t i = 0; i < poses.size(); ++i) keyframes[i].world_from_body = poses[i].pose;
    const Pose motion = used.alignment(keyframes);
    for (ScaledPose& each : poses) each.pose = normalized(motion * each.pose);
  }
};

/// The strategies below compute poses and weights. They return the summary of the last solve with
/// the cost at the initial values.
///
/// One solve, with any loss.
PoseGraphSummary solve_once(Optimisation& run, Report& report) {
  double before = 0.0;
  const Group group = run.settings.group;
  const bool has_equations = group == Group::se2 || group == Group::se3;
  if (run.options.start == Start::chordal && has_equations &&
      run.settings.loss == RobustLoss::none) {
    before = report.time("loop equations",
                         [&] { return solve_loops(run.problem, run.poses, run.iterations); });
  }
  PoseGraphSummary out = report.time("solve", [&] { return run.solve(run.settings); });
  if (before != 0.0) out.cost_before = before;
  return out;
}

/// Weights of the closures that have the derivative of dcs at the current poses [-].
std::vector<double> dcs_weights(const Optimisation& run) {
  std::vector<double> out = squared_errors(run.poses, run.problem.closures, run.settings);
  for (double& x : out) x = loss_derivative(run.settings, x);
  return out;
}

/// Notes if dcs leaves most closures without influence.
void note_ignored(const std::vector<double>& weights, Report& report) {
  constexpr double kLittle = 0.05;
  const auto ignored =
      std::ranges::count_if(weights, [](double weight) { return weight < kLittle; });
  if (2 * ignored <= std::ssize(weights)) return;
  report.notes.push_back(std::to_string(ignored) + " of " + std::to_string(weights.size()) +
                         " closures have less than 5 % of their weight: the result is close to the "
                         "odometry");
}

/// Chooses between two initial values and sets the poses to the one from which dcs reaches the
/// lower cost: the given poses, or the solution of a continuation that uses the smoothed loss and
/// shrinks its width from the largest squared error by a factor of 0.7 per solve. Returns the cost
/// at the given poses.
double anneal(Optimisation& run) {
  const PoseGraphSettings& settings = run.settings;
  const std::vector<ScaledPose> start = run.poses;
  const std::vector<double> squared = squared_errors(start, run.problem.closures, settings);
  const PoseGraphSummary direct = run.solve(settings);
  run.poses = start;
  PoseGraphSettings intermediate = settings;
  intermediate.max_iterations = std::min(settings.max_iterations, 30);
  intermediate.tolerance = std::max(settings.tolerance, 1e-6);
  intermediate.is_smoothed = true;  // also bounded, with fewer false minima
  double width = *std::ranges::max_element(squared);
  for (; width > 1.4 * settings.loss_width; width *= 0.7) {
    intermediate.loss_width = width;
    run.solve(intermediate);
  }
  constexpr double kOtherMinimum = 1e-6;  // relative cost difference that indicates another minimum
  const std::vector<ScaledPose> annealed = run.poses;
  const bool is_lower = run.solve(settings).cost < direct.cost * (1.0 - kOtherMinimum);
  run.poses = is_lower ? annealed : start;
  return direct.cost_before;
}

/// dcs: a solve from annealed initial values. Under a robust loss its last steps are short and
/// inexact. To converge, the same minimum is then solved from the same start with fixed weights
/// taken from the loss.
PoseGraphSummary solve_dcs(Optimisation& run, Report& report) {
  constexpr int kRounds = 3;
  const double before = report.time("anneal", [&] { return anneal(run); });
  const std::vector<ScaledPose> start = run.poses;
  PoseGraphSummary out = report.time("solve", [&] { return run.solve(run.settings); });
  out.cost_before = before;
  PoseGraphSettings weighted = run.settings;
  weighted.loss = RobustLoss::none;
  for (int round = 0; round < kRounds; ++round) {
    run.weights = dcs_weights(run);
    run.poses = start;
    run.solve(weighted);
  }
  return out;
}

/// Graduated non-convexity, and a solve with the weights that it found.
PoseGraphSummary solve_graduated(Optimisation& run, Report& report) {
  const auto values = [&](const Problem& of) { return initial(of, run.options, run.cache); };
  const double largest = inlier_chi2(dimensions(run.settings.group));
  GncSolution gnc = solve_gnc({run.problem, run.settings, largest, values, run.cache}, report);
  run.poses = std::move(gnc.poses);
  run.weights = std::move(gnc.weights);
  run.iterations = gnc.iterations;
  report.count("gnc_rounds", gnc.rounds);
  report.count("closures_kept", static_cast<double>(kept_count(run.weights)));
  report.rejected = rejected_closures(run.weights);
  PoseGraphSummary out = report.time("solve", [&] { return run.solve(run.settings); });
  out.cost_before = gnc.cost_before;
  return out;
}

/// Solves the problem with its covariances as they are.
Trajectory optimised(const Problem& problem,
                     const PoseGraphOptimizer::Options& options,
                     Report& report) {
  const UsedAnchors used(problem, is_level(problem, options));
  Optimisation run{problem,
                   options,
                   settings_of(problem, options, used),
                   std::vector<double>(problem.closures.size(), 1.0)};
  const bool is_dcs = options.loss == RobustLoss::dcs;
  const bool is_gnc = options.gnc != Gnc::off;
  const bool has_dcs_weights = is_dcs && !is_gnc && !problem.closures.empty();
  if (!is_gnc) run.set_initial_poses(used, report);
  used.report_held_pose(report);
  const PoseGraphSummary summary = [&] {
    if (is_gnc) return solve_graduated(run, report);
    return has_dcs_weights ? solve_dcs(run, report) : solve_once(run, report);
  }();
  report.count("iterations", run.iterations);
  const bool is_robust = options.loss != RobustLoss::none;
  report.count(is_robust ? "robust_chi2_before" : "chi2_before", 2.0 * summary.cost_before);
  report.count(is_robust ? "robust_chi2" : "chi2", 2.0 * summary.cost);
  if (!is_robust) {
    const std::size_t edges = problem.odometry.size() + kept_count(run.weights);
    const std::size_t dof =
        degrees_of_freedom(problem.keyframes.size(), edges, dimensions(run.settings.group));
    count_chi2_per_dof(2.0 * summary.cost, dof + used.degrees_of_freedom(), report);
  }
  if (is_dcs) {
    const std::vector<double> weights = dcs_weights(run);
    note_ignored(weights, report);
    if (has_dcs_weights) report.rejected = rejected_closures(weights);
  }
  if (!summary.converged) {
    report.notes.push_back(
        "the last solve stopped at max_iterations before reaching the tolerance");
  }
  if (options.covariances) {
    if (has_dcs_weights) run.settings.loss = RobustLoss::none;  // the weights contain it
    report.covariances = report.time("covariances", [&] {
      return graph_covariances(
          run.poses, {problem.odometry, problem.closures, run.weights}, run.settings);
    });
  }
  Trajectory out = problem.keyframes;
  for (std::size_t i = 0; i < out.size(); ++i) out[i].world_from_body = run.poses[i].pose;
  return out;
}

}  // namespace

std::string PoseGraphOptimizer::why_declined(const Problem& problem) const {
  if (problem.closures.empty() && problem.anchors.empty()) {
    return "the problem has no loop closures";
  }
  if (std::string fault = anchors_fault(problem); !fault.empty()) return fault;
  if (!problem.anchors.empty() && options_.group == Poses::sim3)
    return "group is sim3, which has no anchors";
  if (options_.group == Poses::se2 && !problem.planar)
    return "group is se2, but the problem is not planar";
  if (options_.gravity) {
    if (std::string fault = gravity_fault(problem); !fault.empty()) return fault;
    if (options_.group == Poses::sim3) return "group is sim3, but gravity holds rigid poses";
  }
  if (is_calibrated(options_)) {
    if (std::string why = why_not_calibrated(problem); !why.empty()) return why;
  }
  if (const auto unreached = first_unconnected(problem)) {
    return "the graph is not connected: no path from keyframe " + problem.name_of(0) +
           " to keyframe " + problem.name_of(*unreached);
  }
  return "";
}

Trajectory PoseGraphOptimizer::correct(const Problem& stated, Report& report) const {
  std::optional<Problem> changed;
  const auto problem = [&]() -> const Problem& { return changed ? *changed : stated; };
  const auto bound_stiffness = [&] {
    if (!is_stiff(problem())) return;
    report.notes.push_back(
        "closure information above 1e6 times the odometry's is reduced to that bound: the normal "
        "equations would be singular to rounding");
    changed = with_bounded_stiffness(problem());
  };
  bound_stiffness();
  if (std::optional<Problem> scaled = calibrated_if_asked(options_, problem(), report)) {
    changed = std::move(scaled);
    bound_stiffness();
  }
  if (!options_.gravity) return optimised(problem(), options_, report);
  if (problem().planar) {
    report.notes.push_back("gravity has no effect: poses in a plane have no roll and pitch");
    return optimised(problem(), options_, report);
  }
  const LevelledProblem levelled(problem());
  levelled.report_tilt(report);
  return levelled.tilted(optimised(levelled.problem(), options_, report));
}

}  // namespace loopbench::methods
