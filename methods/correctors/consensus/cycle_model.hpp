/// Errors of the loops of a chain, and their joint covariance, at given poses.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "methods/correctors/consensus/reduced_chain.hpp"

namespace loopbench::methods::consensus {

/// Logarithms of the factors on stated standard deviations.
struct LogFactors {
  double translation = 0.0;  ///< of the odometry
  double rotation = 0.0;     ///< of the odometry
  double closures = 0.0;
};

/// Linear model of all loops in the world frame, at poses X. An error e of a step turns everything
/// after it by the twist Ad(X_end) e, whatever the loop, so that a loop's error
///
///     rho = Log(X_from Z X_to^-1) + sum over its steps of Ad(X_end) Log(M^-1 X_begin^-1 X_end)
///
/// has the covariance t^2 T + r^2 R + s^2 B, where T and R are differences of prefix sums over the
/// chain, for two loops over the steps that they share. Z, M: measured motion of closure and step.
/// The logarithm is that of the group: a gap by one wrong heading is linear in it, however large.
template <class G>
class CycleModel {
 public:
  using Element = typename G::Element;
  using Tangent = typename G::Tangent;
  using Square = typename G::Square;

  CycleModel(const ReducedChain<G>& chain, std::vector<Element> poses)
      : chain_(&chain), poses_(std::move(poses)) {
    const std::size_t nodes = poses_.size();
    step_error_.assign(nodes, Tangent::Zero());
    translation_.assign(nodes, Square::Zero());
    rotation_.assign(nodes, Square::Zero());
    if (chain.has_mixed) mixed_.assign(nodes, Square::Zero());
    if (chain.has_unknown) unknown_.assign(nodes, Square::Zero());
    std::vector<Square> adjoint(nodes);
    for (std::size_t k = 0; k < nodes; ++k) adjoint[k] = G::adjoint(poses_[k]);
    for (std::size_t k = 0; k + 1 < nodes; ++k) {
      const ChainStep<G>& step = chain.steps[k];
      const Square& at = adjoint[k + 1];
      const Element motion = G::compose(G::inverse(poses_[k]), poses_[k + 1]);
      const Tangent error = G::log(G::compose(G::inverse(step.measured), motion));
      step_error_[k + 1] = step_error_[k] + at * error;
      const auto add = [&](std::vector<Square>& sums, const Square& part) {
        sums[k + 1] = sums[k] + at * part * at.transpose();
      };
      add(translation_, step.translation);
      add(rotation_, step.rotation);
      if (chain.has_mixed) add(mixed_, step.mixed);
      if (chain.has_unknown) add(unknown_, step.unknown);
    }
    for (const ChainLoop<G>& loop : chain.loops) {
      const Element end = G::compose(poses_[loop.from], loop.measured);
      rho_.push_back(G::log(G::compose(end, G::inverse(poses_[loop.to]))) + step_error_[loop.to] -
                     step_error_[loop.from]);
      const Square& at = adjoint[loop.to];
      own_.push_back(at * loop.covariance * at.transpose());
      Square part = Square::Zero();
      constexpr int kFirst = kTranslation<G>;
      part.template topLeftCorner<kFirst, kFirst>() =
          loop.covariance.template topLeftCorner<kFirst, kFirst>();
      own_translation_.push_back(at * part * at.transpose());
    }
  }

  const ReducedChain<G>& chain() const { return *chain_; }
  const std::vector<Element>& poses() const { return poses_; }
  std::size_t size() const { return rho_.size(); }
  const Tangent& rho(std::size_t loop) const { return rho_[loop]; }
  const Square& own(std::size_t loop) const { return own_[loop]; }
  /// The part of own() that the deviations of the closure's translation cause.
  const Square& own_translation(std::size_t loop) const { return own_translation_[loop]; }
  double log_uniform() const { return chain_->log_uniform; }

  const std::vector<Square>& translation_sums() const { return translation_; }
  const std::vector<Square>& rotation_sums() const { return rotation_; }
  const std::vector<Square>& mixed_sums() const { return mixed_; }      ///< empty: all zero
  const std::vector<Square>& unknown_sums() const { return unknown_; }  ///< empty: all zero

  /// Prefix sums of the steps' covariances under the factors, one per node.
  std::vector<Square> step_sums(const LogFactors& at) const {
    const double t = std::exp(at.translation), r = std::exp(at.rotation);
    std::vector<Square> out(poses_.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k] = t * t * translation_[k] + r * r * rotation_[k];
      if (!mixed_.empty()) out[k] += t * r * mixed_[k];
      if (!unknown_.empty()) out[k] += unknown_[k];
    }
    return out;
  }

  /// Difference of prefix sums over the steps that two loops share; zero if there are none.
  Square shared(const std::vector<Square>& sums, std::size_t a, std::size_t b) const {
    const ChainLoop<G>& first = chain_->loops[a];
    const ChainLoop<G>& second = chain_->loops[b];
    const std::size_t begin = std::max(first.from, second.from);
    const std::size_t end = std::min(first.to, second.to);
    if (end <= begin) return Square::Zero();
    return sums[end] - sums[begin];
  }

  /// Poses after the correction of maximum density given multipliers of some loops (C^-1 rho).
  /// O(nodes + loops).
  std::vector<Element> corrected(const std::vector<Square>& step_sums,
                                 const std::vector<std::size_t>& loops,
                                 const std::vector<Tangent>& multipliers) const {
    std::vector<Tangent> force(poses_.size() + 1, Tangent::Zero());
    for (std::size_t i = 0; i < loops.size(); ++i) {
      force[chain_->loops[loops[i]].from] += multipliers[i];
      force[chain_->loops[loops[i]].to] -= multipliers[i];
    }
    std::vector<Element> out = poses_;
    Tangent sum = Tangent::Zero(), moved = Tangent::Zero();
    for (std::size_t k = 0; k + 1 < poses_.size(); ++k) {
      sum += force[k];
      moved += (step_sums[k + 1] - step_sums[k]) * sum - (step_error_[k + 1] - step_error_[k]);
      out[k + 1] = G::compose(G::exp(moved), poses_[k + 1]);
    }
    return out;
  }

 private:
  const ReducedChain<G>* chain_;
  std::vector<Element> poses_;
  std::vector<Tangent> step_error_;  ///< prefix sums, one per node; as the next four
  std::vector<Square> translation_, rotation_, mixed_, unknown_;
  std::vector<Tangent> rho_;
  std::vector<Square> own_, own_translation_;
};

}  // namespace loopbench::methods::consensus
