#include "methods/correctors/pose_graph.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "methods/correctors/anchors.hpp"
#include "methods/correctors/chain.hpp"
#include "methods/correctors/gnc.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/plausibility.hpp"
#include "methods/correctors/scale_drift.hpp"
#include "methods/correctors/variance_components.hpp"
#include "methods/solvers/graph_covariance.hpp"
#include "methods/solvers/initial_values.hpp"
#include "methods/solvers/pose_graph_solver.hpp"
#include "methods/solvers/shared_structure.hpp"

namespace loopbench::methods {
namespace {

/// Derivative of dcs with respect to the squared error, per closure [-].
std::vector<double> loss_weights(const PoseGraphSettings& settings, std::vector<double> squared) {
  const double width = settings.loss_width;
  for (double& x : squared) {
    const double root = 2.0 * width / (width + x);
    x = std::min(1.0, root * root);
  }
  return squared;
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

/// Chooses between two initial values and sets `poses` to the one from which dcs reaches the lower
/// cost: the given poses, or the solution of a continuation that uses the smoothed loss and shrinks
/// its width from the largest squared error by a factor of 0.7 per solve. `solve` minimises from
/// `poses` under the given settings. Returns the cost at the given poses.
double anneal(const std::vector<Edge>& closures,
              const PoseGraphSettings& settings,
              std::vector<ScaledPose>& poses,
              const std::function<PoseGraphSummary(const PoseGraphSettings&)>& solve) {
  const std::vector<ScaledPose> start = poses;
  const std::vector<double> squared = squared_errors(start, closures, settings);
  const PoseGraphSummary direct = solve(settings);
  poses = start;
  PoseGraphSettings intermediate = settings;
  intermediate.max_iterations = std::min(settings.max_iterations, 30);
  intermediate.tolerance = std::max(settings.tolerance, 1e-6);
  intermediate.is_smoothed = true;  // also bounded, with fewer false minima
  double width = *std::ranges::max_element(squared);
  for (; width > 1.4 * settings.loss_width; width *= 0.7) {
    intermediate.loss_width = width;
    solve(intermediate);
  }
  constexpr double kOtherMinimum = 1e-6;  // relative cost difference that indicates another minimum
  std::vector<ScaledPose> annealed = poses;
  const bool is_lower = solve(settings).cost < direct.cost * (1.0 - kOtherMinimum);
  if (is_lower) {
    poses = std::move(annealed);
  } else {
    poses = start;
  }
  return direct.cost_before;
}

using Poses = PoseGraphOptimizer::Poses;
using Start = PoseGraphOptimizer::Start;

Group group_of(const Problem& problem, Poses requested, bool has_drift) {
  if (requested == Poses::se2) return Group::se2;
  if (requested == Poses::se3) return Group::se3;
  if (requested == Poses::sim3 || has_drift) return Group::sim3;
  return problem.planar ? Group::se2 : Group::se3;
}

std::vector<ScaledPose> initial(const Problem& problem,
                                const PoseGraphOptimizer::Options& options,
                                bool has_drift,
                                SharedStructure& structure) {
  const Start start = options.start;
  if (start == Start::chordal) return chordal_values(problem, options.scale_sigma, &structure);
  if (start == Start::odometry) return tree_values(problem);
  // Keyframes have no scale: it is that of the tree.
  std::vector<ScaledPose> out =
      has_drift ? tree_values(problem) : std::vector<ScaledPose>(problem.keyframes.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i].pose = problem.keyframes[i].world_from_body;
  return out;
}

/// Replaces the poses of a chain with few loops by the minimum that the equations of its loops
/// reach from the chordal relaxation, and adds their iterations. Gauss-Newton overestimates the
/// curvature of such chains (16 times on KITTI 00) and takes hundreds of steps; these equations
/// include the curvature of the loops (loop_newton.hpp). Returns the cost at the start; 0: poses
/// are unchanged.
double solve_loops(const Problem& problem, std::vector<ScaledPose>& poses, int& iterations) {
  constexpr int kFewLoops = 20;  // the time of an iteration grows with the cube
  constexpr int kMaxIterations = 100;
  constexpr double kConverged = 1e-12;  // relative change of the cost
  if (!problem.anchors.empty() || !loops_fault(problem, kFewLoops).empty()) return 0.0;
  const NoiseModel noise_model = stated_noise_model(problem);
  std::optional<LoopedChain> chain = chordal_chain(problem, noise_model);
  if (!chain) return 0.0;
  const double before = chain->cost();
  try {
    iterations += chain->minimise(kMaxIterations, kConverged);
  } catch (const std::runtime_error&) {  // not positive definite to rounding
    return 0.0;
  }
  const Trajectory solved = chain->keyframes();
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].pose = solved[i].world_from_body;
  return before;
}

/// Moves initial values of the keyframes to their anchors if the first pose is free.
void align_to_anchors(std::vector<ScaledPose>& poses,
                      const UsedAnchors& used,
                      Trajectory keyframes) {
  if (!used.is_first_free) return;
  for (std::size_t i = 0; i < poses.size(); ++i) keyframes[i].world_from_body = poses[i].pose;
  const Pose motion = used.alignment(keyframes);
  for (ScaledPose& each : poses) each.pose = normalized(motion * each.pose);
}

/// 99 % quantile of the chi-squared distribution with the group's degrees of freedom.
double chi2_quantile(Group group) {
  if (group == Group::se2) return 11.345;
  return group == Group::se3 ? 16.812 : 18.475;
}

std::size_t dimensions(Group group) {
  if (group == Group::se2) return 3;
  return group == Group::se3 ? 6 : 7;
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
  if (options_.rescale) {
    if (has_scale_drift(problem))
      return "rescale requires edges of scale 1, but edges change the scale";
    if (std::string fault = why_no_chain(problem); !fault.empty()) return fault;
  }
  if (const auto unreached = first_unconnected(problem)) {
    return "the graph is not connected: no path from keyframe 0 to keyframe " +
           std::to_string(*unreached);
  }
  return "";
}

Trajectory PoseGraphOptimizer::correct(const Problem& problem, Report& report) const {
  if (is_stiff(problem)) {
    report.notes.push_back(
        "closure information above 1e6 times the odometry's is reduced to that bound: the normal "
        "equations would be singular to rounding");
    return correct(with_bounded_stiffness(problem), report);
  }
  if (options_.rescale) {
    Options stated = options_;
    stated.rescale = false;
    return PoseGraphOptimizer(stated).correct(with_estimated_factors(problem, report), report);
  }
  const bool has_drift = has_scale_drift(problem);
  const Group group = group_of(problem, options_.group, has_drift);
  const bool is_dcs = options_.loss == RobustLoss::dcs;
  PoseGraphSettings settings{group,
                             options_.scale_sigma,
                             options_.loss,
                             options_.loss_width.value_or(is_dcs ? chi2_quantile(group) : 1.0),
                             options_.max_iterations,
                             options_.tolerance};
  SharedStructure structure;  // of the chordal start and the solves
  settings.structure = &structure;
  std::vector<ScaledPose> poses;
  if (options_.gnc == Gnc::off) {
    poses = report.time("initial values",
                        [&] { return initial(problem, options_, has_drift, structure); });
  }
  const UsedAnchors used(problem);
  used.report_held_pose(report);
  settings.anchors = used.anchors;
  settings.is_first_free = used.is_first_free;
  align_to_anchors(poses, used, problem.keyframes);
  std::vector<double> weights(problem.closures.size(), 1.0);
  int iterations = 0;
  const auto solve = [&](const PoseGraphSettings& solve_settings) {
    const PoseGraphSummary summary =
        solve_pose_graph(poses, problem.odometry, problem.closures, weights, solve_settings);
    iterations += summary.iterations;
    return summary;
  };
  double before = 0.0;
  const bool is_rigid_least_squares = group != Group::sim3 && settings.loss == RobustLoss::none;
  if (options_.start == Start::chordal && is_rigid_least_squares && options_.gnc == Gnc::off) {
    before = report.time("loop equations", [&] { return solve_loops(problem, poses, iterations); });
  }
  if (options_.gnc != Gnc::off) {
    const auto values = [&](const Problem& of) {
      return initial(of, options_, has_scale_drift(of), structure);
    };
    GncSolution gnc = solve_gnc({problem, settings, chi2_quantile(group), values}, report);
    poses = std::move(gnc.poses);
    weights = std::move(gnc.weights);
    iterations = gnc.iterations;
    before = gnc.cost_before;
    report.count("gnc_rounds", gnc.rounds);
    report.count("closures_kept", static_cast<double>(kept_count(weights)));
  }
  std::optional<double> annealed_from;
  if (is_dcs && !problem.closures.empty() && options_.gnc == Gnc::off) {
    annealed_from =
        report.time("anneal", [&] { return anneal(problem.closures, settings, poses, solve); });
  }
  const std::vector<ScaledPose> start = annealed_from ? poses : std::vector<ScaledPose>{};
  const PoseGraphSummary summary = report.time("solve", [&] { return solve(settings); });
  if (annealed_from) {
    // Under a robust loss the last steps are short and inexact. To converge, the same minimum is
    // solved from the same start with fixed weights taken from the loss.
    constexpr int kRounds = 3;
    PoseGraphSettings weighted = settings;
    weighted.loss = RobustLoss::none;
    for (int round = 0; round < kRounds; ++round) {
      weights = loss_weights(settings, squared_errors(poses, problem.closures, settings));
      poses = start;
      solve(weighted);
    }
  }
  if (options_.gnc == Gnc::off && before == 0.0) {
    before = annealed_from.value_or(summary.cost_before);
  }
  report.count("iterations", iterations);
  const bool is_robust = options_.loss != RobustLoss::none;
  report.count(is_robust ? "robust_chi2_before" : "chi2_before", 2.0 * before);
  report.count(is_robust ? "robust_chi2" : "chi2", 2.0 * summary.cost);
  if (!is_robust) {
    const std::size_t edges = problem.odometry.size() + kept_count(weights);
    const std::size_t degrees = freedom(problem.keyframes.size(), edges, dimensions(group));
    report_chi2(2.0 * summary.cost, degrees + used.freedom(), report);
  }
  if (is_dcs) {
    note_ignored(loss_weights(settings, squared_errors(poses, problem.closures, settings)), report);
  }
  if (!summary.converged) {
    report.notes.push_back(
        "the last solve stopped at max_iterations before reaching the tolerance");
  }

  if (options_.covariances) {
    if (annealed_from) settings.loss = RobustLoss::none;  // the weights contain it
    report.covariances = report.time("covariances", [&] {
      return graph_covariances(poses, problem.odometry, problem.closures, weights, settings);
    });
  }
  Trajectory out = problem.keyframes;
  for (std::size_t i = 0; i < out.size(); ++i) out[i].world_from_body = poses[i].pose;
  return out;
}

}  // namespace loopbench::methods
