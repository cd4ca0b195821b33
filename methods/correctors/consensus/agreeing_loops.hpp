/// Loops that agree with each other under given factors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "methods/correctors/consensus/elimination.hpp"
#include "methods/correctors/consensus/joint_loops.hpp"

namespace loopbench::methods::consensus {

/// 1 - 1e-4 quantile of chi2 with 3 and 6 degrees of freedom: a loop beyond it is no error of the
/// stated kind, even where the uniform density is low.
template <class G>
inline constexpr double kLargestSquared = G::kDof == 3 ? 21.108 : 27.856;

/// Weight of a slipped closure. One in twenty closures of detectors that verify slips.
inline constexpr double kLogSlipped = -3.0;

/// Log density of a loop as the likeliest outlier: anywhere in the map, or slipped, with 10, 30 or
/// 100 times its deviation, of the translation alone or of both. `error` and `covariance`: given
/// true loops; `own`, `own_translation`: the closure's part of the covariance.
template <class Error, class Covariance>
double outlier_density(const Error& error,
                       const Covariance& covariance,
                       const Covariance& own,
                       const Covariance& own_translation,
                       double log_uniform) {
  const double log_weight = kLogSlipped - std::log(6.0);
  double out = log_uniform;
  for (const double factor : {10.0, 30.0, 100.0}) {
    for (const Covariance* part : {&own_translation, &own}) {
      const Covariance wider = covariance + (factor * factor - 1.0) * *part;
      out = std::max(out, normal_density(error, wider).log_density + log_weight);
    }
  }
  return out;
}

template <class G>
double outlier_density(const CycleModel<G>& model,
                       std::size_t loop,
                       const typename G::Tangent& error,
                       const typename G::Square& covariance,
                       double closure_variance) {
  return outlier_density<typename G::Tangent, typename G::Square>(
      error,
      covariance,
      closure_variance * model.own(loop),
      closure_variance * model.own_translation(loop),
      model.log_uniform());
}

template <class G>
bool is_usable(const std::vector<typename G::Element>& poses) {
  constexpr double kFar = 1e7;  // [m]
  return std::ranges::all_of(poses, [](const typename G::Element& each) {
    const Vector3 at = G::to_scaled_pose(each).pose.translation;
    return at.allFinite() && at.norm() < kFar;
  });
}

/// Moves the model to the poses that its loops correct. Returns false, with the model unchanged, if
/// the linear model does not hold: poses leave the map or covariances are not positive definite.
template <class G>
bool relinearise(CycleModel<G>& model,
                 const LogFactors& factors,
                 const std::vector<std::size_t>& loops) {
  const JointLoops<G> joint(model, factors, loops);
  if (!joint.is_positive()) return false;
  std::vector<typename G::Element> poses = joint.corrected();
  if (!is_usable<G>(poses)) return false;
  model = CycleModel<G>(model.chain(), std::move(poses));
  return true;
}

/// Adds the loop of the highest density given those so far, while it is above the uniform one. A
/// loop that turns the chain moves the model, at most `relinearisations` times. Starts with
/// `loops`; returns all in their order, empty if they are together less likely than as outliers.
template <class G>
std::vector<std::size_t> agreeing_loops(CycleModel<G>& model,
                                        const LogFactors& factors,
                                        std::vector<std::size_t> loops,
                                        int relinearisations) {
  constexpr double kFirst = -8.0;  // log odds of the first loop, which others can make up for
  double turn_limit = 0.05;        // [rad]
  Elimination<G> eliminated(model, factors);
  std::vector<bool> is_done(model.size(), false);
  for (const std::size_t each : loops) {
    if (!eliminated.condition_on(each)) return {};
    is_done[each] = true;
  }
  while (loops.size() < model.size()) {
    double best = -std::numeric_limits<double>::infinity();
    std::size_t next = model.size();
    for (std::size_t a = 0; a < model.size(); ++a) {
      if (is_done[a]) continue;
      const ErrorDensity at = eliminated.density(a);
      if (at.squared > kLargestSquared<G> || !(at.log_density > best)) continue;
      best = at.log_density;
      next = a;
    }
    if (next == model.size()) break;
    const double gain = best - model.log_uniform();
    if (gain < (loops.empty() ? kFirst : 0.0)) break;
    const double turn =
        eliminated.error(next).template tail<G::kDof - kTranslation<G>>().cwiseAbs().maxCoeff();
    if (!eliminated.condition_on(next)) break;
    loops.push_back(next);
    is_done[next] = true;
    if (turn < turn_limit || relinearisations <= 0) continue;
    --relinearisations;
    turn_limit *= 1.2;
    for (int step = 0; step < 2; ++step) {
      if (!relinearise(model, factors, loops)) return loops;
    }
    eliminated = Elimination<G>(model, factors);
    if (!eliminated.condition_on(loops)) return loops;
  }
  if (eliminated.log_odds() <= 0.0) loops.clear();
  return loops;
}

}  // namespace loopbench::methods::consensus
