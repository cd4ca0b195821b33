#include "methods/correctors/dual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "methods/correctors/anchors.hpp"
#include "methods/correctors/chain.hpp"
#include "methods/correctors/chi_squared.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/pose_graph.hpp"

namespace loopbench::methods {
namespace {

/// Edge from the first keyframe to that of the anchor.
Edge edge_of(const Anchor& anchor, const Pose& world_from_first) {
  const Matrix3 R = world_from_first.rotation.toRotationMatrix();
  Edge out{0, anchor.keyframe, {}};
  out.from_from_to.translation = world_from_first.inverse() * anchor.position;
  out.information.topLeftCorner<3, 3>() = R.transpose() * anchor.covariance.inverse() * R;
  return out;
}

/// Largest distance from the first keyframe, at least 1 [m].
double size_of(const Trajectory& keyframes) {
  double out = 1.0;
  for (const StampedPose& each : keyframes) {
    const Vector3 offset =
        each.world_from_body.translation - keyframes.front().world_from_body.translation;
    out = std::max(out, offset.norm());
  }
  return out;
}

/// An anchor is a loop from a keyframe that does not move, in which only a position is measured. If
/// the first pose is held, that is the first keyframe. If it is free, a keyframe is put in front of
/// it, at the same pose, and joined to it by an edge with a wide covariance: the size of the chain
/// [m] (at least 1 m) and 1 rad. This edge costs nothing once the first pose no longer moves, so
/// solve again from each solution until it does not (a proximal point iteration).
struct AnchoredChain {
  Problem problem;                             ///< odometry and loops; closures, then anchors
  std::vector<std::optional<Vector3>> points;  ///< of LoopedChain, one per closure
  bool has_front;                              ///< a keyframe was put in front
  double size;  ///< largest distance from the first keyframe, >= 1 [m]

  AnchoredChain(const Problem& of, const UsedAnchors& used)
      : problem{of.keyframes, of.odometry, of.closures, {}, of.planar},
        points(of.closures.size()),
        has_front(used.is_first_free),
        size(size_of(of.keyframes)) {
    const Pose& first = of.keyframes.front().world_from_body;
    for (const Anchor& anchor : used.anchors) {
      problem.closures.push_back(edge_of(anchor, first));
      points.emplace_back(anchor.point_in_body);
    }
    if (!has_front) return;
    for (std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
      for (Edge& edge : *edges) ++edge.from, ++edge.to;
    }
    for (std::size_t k = of.closures.size(); k < problem.closures.size(); ++k) {
      problem.closures[k].from = 0;
    }
    problem.keyframes.insert(problem.keyframes.begin(), problem.keyframes.front());
    Edge wide{0, 1, {}};
    wide.information.topLeftCorner<3, 3>() /= size * size;
    problem.odometry.insert(problem.odometry.begin(), wide);
  }

  /// Returns the keyframes of the original problem. O(keyframes).
  Trajectory without_front(Trajectory keyframes) const {
    if (has_front) keyframes.erase(keyframes.begin());
    return keyframes;
  }
};

/// The problem without the measurements that are not used; nullopt: all are used.
std::optional<Problem> used_part(const Problem& problem, Dual::Use use) {
  if (use == Dual::Use::all) return std::nullopt;
  Problem out = problem;
  if (use == Dual::Use::closures) out.anchors.clear();
  if (use == Dual::Use::anchors) out.closures.clear();
  return out;
}

Trajectory correct_rigid(const Dual::Options& options, const Problem& stated, Report& report) {
  const std::optional<Problem> scaled = calibrated_if_asked(options, stated, report);
  const Problem& problem = scaled ? *scaled : stated;
  const NoiseModel noise_model = stated_noise_model(problem);
  const LoopedChain solved = lowest_minimum(
      problem,
      noise_model,
      {options.max_iterations, options.tolerance, options.start == Dual::Start::automatic},
      report);
  count_chi2_per_dof(2.0 * solved.cost(), degrees_of_freedom(problem), report);
  if (options.covariances) {
    report.covariances = report.time("covariances", [&] { return solved.covariances(); });
  }
  return solved.keyframes();
}

double cost_of(const AnchoredChain& at) {
  return LoopedChain(at.problem, stated_noise_model(at.problem), at.points).cost();
}

/// The solution of pose_graph. From the keyframes, the equations of the loops can end in another
/// minimum where the chain has drifted by a quarter of a rotation. nullopt: there is none.
std::optional<Trajectory> graph_solution(const Problem& problem) {
  Report unused;
  try {
    return PoseGraphOptimizer({.start = PoseGraphOptimizer::Start::chordal})
        .correct(problem, unused);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

Trajectory correct_anchored(const Dual::Options& options, const Problem& stated, Report& report) {
  constexpr int kMaxRounds = 100;
  constexpr double kAtRest = 1e-10;  // of the first pose [rad], and of the chain's size [m]
  const UsedAnchors used(stated);
  used.report_held_pose(report);
  Problem problem{stated.keyframes, stated.odometry, stated.closures, {}, stated.planar};
  const Pose motion = used.alignment(problem.keyframes);
  for (StampedPose& each : problem.keyframes) {
    each.world_from_body = normalized(motion * each.world_from_body);
  }
  report.count("chi2_before", 2.0 * cost_of(AnchoredChain(problem, used)));
  if (options.start == Dual::Start::automatic) {
    auto solved = report.time("initial values", [&] { return graph_solution(stated); });
    if (solved) problem.keyframes = *std::move(solved);
  }
  double chi2 = 0.0;
  int iterations = 0;
  bool is_at_rest = false;
  for (int round = 0; round < kMaxRounds && !is_at_rest; ++round) {
    const AnchoredChain anchored(problem, used);
    LoopedChain chain(anchored.problem, stated_noise_model(anchored.problem), anchored.points);
    if (!std::isfinite(chain.cost())) throw std::runtime_error("dual: the cost is not finite");
    iterations += chain.minimise(options.max_iterations, options.tolerance);
    Trajectory solved = anchored.without_front(chain.keyframes());
    const Pose& before = problem.keyframes.front().world_from_body;
    const Twist moved = log_se3(before.inverse() * solved.front().world_from_body);
    is_at_rest = !anchored.has_front || (moved.tail<3>().norm() < kAtRest &&
                                         moved.head<3>().norm() < kAtRest * anchored.size);
    problem.keyframes = std::move(solved);
    chi2 = 2.0 * chain.cost();
    if (options.covariances && is_at_rest) {
      report.covariances =
          report.time("covariances", [&] { return chain.covariances(anchored.has_front); });
      if (anchored.has_front) report.covariances.erase(report.covariances.begin());
    }
  }
  if (!is_at_rest) report.notes.push_back("the first pose was still moving when iterations ended");
  report.count("iterations", iterations);
  report.count("chi2", chi2);
  count_chi2_per_dof(chi2, degrees_of_freedom(problem) + used.degrees_of_freedom(), report);
  return problem.keyframes;
}

}  // namespace

std::string Dual::why_declined(const Problem& stated) const {
  const std::optional<Problem> part = used_part(stated, options_.use);
  const Problem& problem = part ? *part : stated;
  if (std::string fault = anchors_fault(problem); !fault.empty()) return fault;
  if (has_scale_drift(problem)) {
    return "edges change the scale, which this method does not estimate: use pose_graph";
  }
  if (is_calibrated(options_)) {
    if (std::string why = why_not_calibrated(problem); !why.empty()) return why;
  }
  const auto limit = static_cast<std::size_t>(options_.max_closures);
  const bool is_above = problem.closures.size() + problem.anchors.size() > limit;
  return loops_fault(problem, options_.max_closures) + (is_above ? ": use pose_graph" : "");
}

Trajectory Dual::correct(const Problem& stated, Report& report) const {
  const std::optional<Problem> part = used_part(stated, options_.use);
  const Problem& problem = part ? *part : stated;
  return problem.anchors.empty() ? correct_rigid(options_, problem, report)
                                 : correct_anchored(options_, problem, report);
}

}  // namespace loopbench::methods
