#include "methods/correctors/consensus/calibrated.hpp"

#include "methods/correctors/consensus/judgement_text.hpp"
#include "methods/correctors/consensus/unknown_motion.hpp"

namespace loopbench::methods {

std::string why_not_calibrated(const Problem& problem) {
  if (problem.closures.empty()) return "";  // nothing contradicts the stated deviations
  const std::string why = why_not_judged(problem);
  return why.empty() ? "" : "calibrate requires closures that can be judged, but " + why;
}

Problem calibrated(const Problem& problem, Report& report) {
  Problem out = problem;
  if (problem.closures.empty()) return out;
  const ClosureJudgement found = report.time("judge", [&] { return judge_closures(problem); });
  const EstimatedFactors factors = found.is_decided() ? found.factors : EstimatedFactors{};
  if (!found.is_decided()) {
    report.notes.push_back("calibrate: the stated standard deviations are used because " +
                           undecided_text(found));
  }
  report.count("factor_t", factors.translation);
  report.count("factor_r", factors.rotation);
  report.count("factor_closures", factors.closures);
  Twist shrink;
  shrink.head<3>().setConstant(1.0 / factors.translation);
  shrink.tail<3>().setConstant(1.0 / factors.rotation);
  for (Edge& edge : out.odometry) {
    if (is_unknown_motion(edge, problem.planar)) continue;
    edge.information = (shrink.asDiagonal() * edge.information * shrink.asDiagonal()).eval();
  }
  for (Edge& edge : out.closures) edge.information /= factors.closures * factors.closures;
  return out;
}

}  // namespace loopbench::methods
