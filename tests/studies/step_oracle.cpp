#include "tests/studies/step_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "methods/correctors/consensus/factor_estimate.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "methods/correctors/consensus/reduced_chain.hpp"
#include "methods/correctors/consensus/step_search.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"

namespace loopbench {
namespace {

using methods::FreedStep;
using methods::consensus::CycleModel;
using methods::consensus::LogFactors;
using methods::consensus::LoopLikelihood;
using methods::consensus::ReducedChain;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 4> kInflations{10.0, 30.0, 100.0, kInfinity};

/// The true closures.
Problem without_false(Problem problem, const std::vector<bool>& is_false) {
  std::vector<Edge> closures;
  for (std::size_t k = 0; k < is_false.size(); ++k) {
    if (!is_false[k]) closures.push_back(problem.closures[k]);
  }
  problem.closures = std::move(closures);
  return problem;
}

LogFactors factors_of(const Problem& problem) {
  const methods::ClosureJudgement found = methods::judge_closures(problem);
  if (!found.is_decided()) return {};
  return {std::log(found.factors.translation),
          std::log(found.factors.rotation),
          std::log(found.factors.closures)};
}

template <class G>
class Oracle {
 public:
  Oracle(const TrueChain& chain, const PlantedProblem& of) : step_(*of.wrong_step) {
    Problem right = without_false(of.problem, of.is_false);
    right.keyframes = chain.problem.keyframes;
    right.odometry = chain.problem.odometry;
    known_ = factors_of(right);
    Problem wrong = without_false(of.problem, of.is_false);
    for (std::size_t k = 0; k < wrong.odometry.size(); ++k) {
      wrong.odometry[k].information = chain.problem.odometry[k].information;
    }
    weight_ = methods::consensus::log_step_weights(wrong);
    std::vector<FreedStep> nodes;  // each keyframe is a node
    for (std::size_t k = 0; k + 1 < chain.truth.size(); ++k) {
      nodes.push_back({k, std::nextafter(1.0, 2.0)});
    }
    for (std::size_t k = 0; k < wrong.closures.size(); ++k) loops_.push_back(k);
    chain_ = methods::consensus::reduced_chain<G>(wrong, loops_, nodes);
    for (const StampedPose& each : chain.truth) {
      poses_.push_back(G::from({each.world_from_body, 1.0}));
    }
  }

  StepOracle run() {
    StepOracle out;
    const LoopLikelihood none(CycleModel<G>(chain_, poses_), loops_);
    LogFactors best_factors = known_;
    double known = -kInfinity, freed = -kInfinity;
    for (const double inflation : kInflations) {
      const LoopLikelihood with = freed_at(step_, inflation);
      known = std::max(known, with.log_odds(known_) + prior(step_));
      const LogFactors at = fitted(with);
      const double value = with.log_posterior(at) + prior(step_);
      if (!(value > freed)) continue;
      freed = value;
      best_factors = at;
    }
    out.with_known_factors = known - none.log_odds(known_);
    out.with_fitted_factors = freed - none.log_posterior(fitted(none));
    double sum = 0.0, most = -kInfinity, planted = 0.0;
    const double zero = freed;  // the share does not depend on it
    for (std::size_t k = 0; k + 1 < poses_.size(); ++k) {
      for (const double inflation : kInflations) {
        const double value = freed_at(k, inflation).log_posterior(best_factors) + prior(k);
        sum += std::exp(std::min(600.0, value - zero));
        if (k == step_) planted += std::exp(std::min(600.0, value - zero));
        if (!(value > most)) continue;
        most = value;
        out.best_step = k;
      }
    }
    out.share = planted / sum;
    return out;
  }

 private:
  double prior(std::size_t step) const {
    return methods::consensus::StepSearch<G>::kLogWrong + weight_[step] -
           std::log(static_cast<double>(kInflations.size()));
  }

  /// The true closures with one step freed.
  LoopLikelihood freed_at(std::size_t step, double inflation) const {
    ReducedChain<G> freed = chain_;
    auto& edge = freed.steps[step];
    if (std::isinf(inflation)) {
      edge.measured = G::compose(G::inverse(poses_[step]), poses_[step + 1]);
      edge.unknown += methods::consensus::unknown_covariance<G>(freed.log_uniform);
      freed.has_unknown = true;
    } else {
      edge.translation *= inflation * inflation;
      edge.rotation *= inflation * inflation;
    }
    return LoopLikelihood(CycleModel<G>(freed, poses_), loops_);
  }

  /// From the factors that are right, and from larger ones, which hide a wrong step.
  LogFactors fitted(const LoopLikelihood& loops) const {
    LogFactors best = known_;
    for (const double octaves : {0.0, 2.0, 4.0}) {
      const double by = octaves * std::log(2.0);
      const LogFactors at = methods::consensus::climb(
          loops, {known_.translation + by, known_.rotation + by, known_.closures}, 0.7, 0.06);
      if (loops.log_posterior(at) > loops.log_posterior(best)) best = at;
    }
    return best;
  }

  std::size_t step_;
  LogFactors known_;
  std::vector<double> weight_;
  std::vector<std::size_t> loops_;
  ReducedChain<G> chain_;
  std::vector<typename G::Element> poses_;
};

}  // namespace

StepOracle step_oracle(const TrueChain& chain, const PlantedProblem& of) {
  return chain.problem.planar ? Oracle<methods::Se2>(chain, of).run()
                              : Oracle<methods::Se3>(chain, of).run();
}

}  // namespace loopbench
