#include "methods/correctors/dual.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "methods/correctors/anchored_chain.hpp"
#include "methods/correctors/chain.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/correctors/plausibility.hpp"
#include "methods/correctors/scale_drift.hpp"
#include "methods/correctors/variance_components.hpp"

namespace loopbench::methods {
namespace {

Dual::Options with_all(Dual::Options options) {
  options.use = Dual::Use::all;
  return options;
}

}  // namespace

Problem Dual::used_part(const Problem& problem) const {
  Problem out = problem;
  if (options_.use == Use::closures) out.anchors.clear();
  if (options_.use == Use::anchors) out.closures.clear();
  return out;
}

std::string Dual::why_declined(const Problem& problem) const {
  if (options_.use != Use::all) return Dual(with_all(options_)).why_declined(used_part(problem));
  if (std::string fault = anchors_fault(problem); !fault.empty()) return fault;
  if (has_scale_drift(problem)) {
    return "edges change the scale, which this method does not estimate: use pose_graph";
  }
  return loops_fault(problem, options_.max_closures);
}

Trajectory Dual::correct(const Problem& problem, Report& report) const {
  if (options_.use != Use::all) {
    return Dual(with_all(options_)).correct(used_part(problem), report);
  }
  if (!problem.anchors.empty()) return correct_anchored(options_, problem, report);
  return correct_rigid(options_, problem, report);
}

Trajectory Dual::correct_rigid(const Options& options, const Problem& stated, Report& report) {
  std::optional<Problem> scaled;
  if (options.rescale) scaled = with_estimated_factors(stated, report);
  const Problem& problem = scaled ? *scaled : stated;
  const NoiseModel noise_model = stated_noise_model(problem);
  const std::size_t degrees = freedom(problem);
  LoopedChain first(problem, noise_model);
  report.count("chi2_before", 2.0 * first.cost());
  if (!std::isfinite(first.cost())) throw std::runtime_error("dual: the cost is not finite");
  int iterations = first.minimise(options.max_iterations, options.tolerance);
  const LoopedChain* best = &first;
  const bool is_implausible = is_too_large(2.0 * first.cost(), degrees);
  std::optional<LoopedChain> second = options.start == Start::automatic && is_implausible
                                          ? chordal_chain(problem, noise_model)
                                          : std::nullopt;
  if (second) {
    constexpr double kOtherMinimum = 1e-6;  // relative cost difference between two minima
    iterations += second->minimise(options.max_iterations, options.tolerance);
    if (second->cost() < first.cost() * (1.0 - kOtherMinimum)) {
      best = &*second;
      report.notes.push_back(fmt::format(
          "two minima: chi2 {:.6g} from the keyframes, {:.6g} from chordal relaxation; the lower "
          "one is returned",
          2.0 * first.cost(),
          2.0 * second->cost()));
    }
  }
  report.count("iterations", iterations);
  report.count("chi2", 2.0 * best->cost());
  report_chi2(2.0 * best->cost(), degrees, report);
  if (options.covariances) {
    report.covariances = report.time("covariances", [&] { return best->covariances(); });
  }
  return best->keyframes();
}

Trajectory Dual::correct_anchored(const Options& options, const Problem& stated, Report& report) {
  constexpr int kMaxRounds = 100;
  constexpr double kAtRest = 1e-10;  // of the first pose [rad], and of the chain's size [m]
  const UsedAnchors used(stated);
  used.report_held_pose(report);
  Problem problem{stated.keyframes, stated.odometry, stated.closures, {}, stated.planar};
  const Pose motion = used.alignment(problem.keyframes);
  for (StampedPose& each : problem.keyframes) {
    each.world_from_body = normalized(motion * each.world_from_body);
  }
  double chi2 = 0.0;
  int iterations = 0;
  bool is_at_rest = false;
  for (int round = 0; round < kMaxRounds && !is_at_rest; ++round) {
    const AnchoredChain anchored(problem, used);
    LoopedChain chain(anchored.problem, stated_noise_model(anchored.problem), anchored.points);
    if (!std::isfinite(chain.cost())) throw std::runtime_error("dual: the cost is not finite");
    if (round == 0) report.count("chi2_before", 2.0 * chain.cost());
    iterations += chain.minimise(options.max_iterations, options.tolerance);
    Trajectory solved = anchored.without_front(chain.keyframes());
    const Pose& before = problem.keyframes.front().world_from_body;
    const Twist moved = log_se3(before.inverse() * solved.front().world_from_body);
    is_at_rest = !anchored.has_front || (moved.tail<3>().norm() < kAtRest &&
                                         moved.head<3>().norm() < kAtRest * anchored.size());
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
  report_chi2(chi2, freedom(problem) + used.freedom(), report);
  return problem.keyframes;
}

}  // namespace loopbench::methods
