#include "methods/correctors/consensus/judgement.hpp"

#include <algorithm>
#include <cmath>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/consensus/judge.hpp"
#include "methods/correctors/consensus/odometry_fault.hpp"
#include "methods/correctors/consensus/unknown_motion.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/initial_values.hpp"

namespace loopbench::methods {
namespace {

/// Adds an edge for each step without odometry: the keyframes' motion, with deviations of the size
/// of the map and of half a turn.
void add_unknown_steps(Problem& problem) {
  double size = 1.0;  // [m]
  for (const StampedPose& each : problem.keyframes) {
    const Vector3 offset =
        each.world_from_body.translation - problem.keyframes.front().world_from_body.translation;
    size = std::max(size, 2.0 * offset.norm());
  }
  std::vector<bool> has_edge(problem.keyframes.size(), false);
  for (const Edge& edge : problem.odometry) has_edge[edge.from] = true;
  for (std::size_t k = 0; k + 1 < problem.keyframes.size(); ++k) {
    if (has_edge[k]) continue;
    const Pose motion =
        problem.keyframes[k].world_from_body.inverse() * problem.keyframes[k + 1].world_from_body;
    Edge edge{k, k + 1, normalized(motion)};
    edge.information.diagonal().head<3>().setConstant(1.0 / (size * size));
    edge.information.diagonal().tail<3>().setConstant(1.0 / (M_PI * M_PI));
    problem.odometry.push_back(edge);
  }
  std::ranges::sort(problem.odometry, {}, &Edge::from);
}

/// The problem without the odometry edges of unknown motion.
Problem measured_part(Problem problem) {
  std::erase_if(problem.odometry,
                [&](const Edge& edge) { return is_unknown_motion(edge, problem.planar); });
  return problem;
}

bool is_motion_measured(const Problem& problem) {
  return 2 * problem.odometry.size() >= problem.keyframes.size() - 1;
}

NotJudged no_odometry(const Problem& problem) {
  if (has_scale_drift(problem)) {
    return {"edges change the scale", ", which this method does not estimate: use pose_graph"};
  }
  const Problem measured = measured_part(problem);
  if (const auto unreached = first_unconnected(measured)) {
    return {"the graph is not connected: no path from keyframe " + problem.name_of(0) +
            " to keyframe " + problem.name_of(*unreached)};
  }
  if (!is_motion_measured(measured)) {
    return {"odometry joins " + std::to_string(measured.odometry.size()) + " of " +
                std::to_string(problem.keyframes.size() - 1) +
                " pairs of neighbouring keyframes, fewer than half",
            ": use pose_graph"};
  }
  return {};
}

}  // namespace

std::string why_no_odometry(const Problem& problem) { return no_odometry(problem).text(); }

NotJudged not_judged(const Problem& problem) {
  if (problem.closures.empty()) return {"the problem has no loop closures"};
  return no_odometry(problem);
}

std::string why_not_judged(const Problem& problem) { return not_judged(problem).text(); }

ClosureJudgement judge_closures(const Problem& problem) {
  const Problem measured = measured_part(problem);
  return problem.planar ? consensus::Judge<Se2>(measured).run()
                        : consensus::Judge<Se3>(measured).run();
}

Problem agreed_problem(const Problem& problem, const ClosureJudgement& judgement) {
  Problem out{problem.keyframes, measured_part(problem).odometry, {}, {}, problem.planar};
  out.ids = problem.ids;
  Twist shrink;
  shrink.head<3>().setConstant(1.0 / judgement.factors.translation);
  shrink.tail<3>().setConstant(1.0 / judgement.factors.rotation);
  for (const FreedStep& step : judgement.steps) {
    const auto edge = std::ranges::lower_bound(out.odometry, step.from, {}, &Edge::from);
    if (std::isinf(step.inflation)) {
      out.odometry.erase(edge);
    } else {
      edge->information /= step.inflation * step.inflation;
    }
  }
  for (Edge& edge : out.odometry) {
    edge.information = (shrink.asDiagonal() * edge.information * shrink.asDiagonal()).eval();
  }
  const double own = 1.0 / (judgement.factors.closures * judgement.factors.closures);
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    if (judgement.closures[k].finding != ClosureFinding::agrees) continue;
    out.closures.push_back(problem.closures[k]);
    out.closures.back().information *= own;
  }
  if (first_unconnected(out)) add_unknown_steps(out);
  return out;
}

}  // namespace loopbench::methods
