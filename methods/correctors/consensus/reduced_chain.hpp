/// A chain with loops, reduced to the keyframes that matter for its loops.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods::consensus {

/// Number of leading tangent coordinates that are a translation: 2 of Se2, 3 of Se3.
template <class G>
inline constexpr int kTranslation = G::kDof == 3 ? 2 : 3;

/// Consecutive odometry edges as one: measured motion, and the parts of its covariance, in the
/// frame of its end. A step of which nothing is measured has the motion of the keyframes.
template <class G>
struct ChainStep {
  typename G::Element measured;
  typename G::Square translation;  ///< from the translation of each edge
  typename G::Square rotation;     ///< from its rotation
  typename G::Square mixed;        ///< from their covariance
  typename G::Square unknown;      ///< of steps without odometry
};

/// A closure between two nodes of the chain, from < to.
template <class G>
struct ChainLoop {
  std::size_t from = 0;
  std::size_t to = 0;
  typename G::Element measured;
  typename G::Square covariance;  ///< as stated
};

/// Nodes are the ends of the loops, both ends of each step that is freed or has no odometry, and
/// some keyframes in between, so that the chain can bend. Poses are relative to the first keyframe,
/// with positions relative to the centre of the chain: the world frame does not matter.
template <class G>
struct ReducedChain {
  std::vector<std::size_t> keyframe;       ///< of each node, ascending
  std::vector<typename G::Element> poses;  ///< of the odometry, one per node
  std::vector<ChainStep<G>> steps;         ///< from each node to the next
  std::vector<ChainLoop<G>> loops;
  double log_uniform = 0.0;  ///< log density of a closure that could be anywhere in the map
  bool has_mixed = false, has_unknown = false;
};

/// Density of a closure's relative pose that is uniform over the box of the positions (in the axes
/// of the first keyframe; each side at least a tenth of the longest, and `least` [m]) and over all
/// rotations.
template <class G>
double log_uniform_density(const std::vector<Vector3>& positions, double least) {
  Vector3 low = positions.front(), high = low;
  for (const Vector3& p : positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vector3 size = high - low;
  double out = -std::log(kTranslation<G> == 2 ? 2.0 * M_PI : 8.0 * M_PI * M_PI);
  for (int i = 0; i < kTranslation<G>; ++i) {
    out -= std::log(std::max({size[i], 0.1 * size.maxCoeff(), least}));
  }
  return out;
}

/// Covariance of a step of which nothing is known, about a motion that closes a loop: 1.5 rad, and
/// the deviation of the translation for which that loop is e times as likely as an outlier.
template <class G>
typename G::Square unknown_covariance(double log_uniform) {
  constexpr double kRotation = 1.5;
  constexpr double kLog2Pi = 1.8378770664093453;
  constexpr int kFirst = kTranslation<G>;
  const double log_translation =
      -(log_uniform + 1.0 + 0.5 * G::kDof * kLog2Pi + (G::kDof - kFirst) * std::log(kRotation)) /
      kFirst;
  typename G::Square out = G::Square::Identity() * kRotation * kRotation;
  for (int i = 0; i < kFirst; ++i) out(i, i) = std::exp(2.0 * log_translation);
  return out;
}

/// Reduces the chain for the given closures, with some steps freed. The odometry is integrated from
/// the first keyframe; where an edge is missing, with the motion between the keyframes.
/// O(keyframes).
template <class G>
class ChainReduction {
 public:
  using Element = typename G::Element;
  using Square = typename G::Square;

  ChainReduction(const Problem& problem,
                 std::span<const std::size_t> closures,
                 std::span<const FreedStep> freed)
      : problem_(problem),
        closures_(closures),
        freed_(freed),
        is_node_(problem.keyframes.size(), false) {}

  ReducedChain<G> run() {
    const std::vector<Element> poses = integrated();
    mark_nodes();
    std::vector<std::size_t> node(poses.size());
    ChainStep<G> step = fresh();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (k > 0) append(step, k - 1);
      if (!is_node_[k]) continue;
      if (k > 0) out_.steps.push_back(std::exchange(step, fresh()));
      node[k] = out_.keyframe.size();
      out_.keyframe.push_back(k);
      out_.poses.push_back(poses[k]);
    }
    for (const std::size_t c : closures_) {
      const Edge& edge = problem_.closures[c];
      out_.loops.push_back({node[edge.from],
                            node[edge.to],
                            G::from(measured(edge)),
                            inverse_of(G::information(edge, 1.0))});
    }
    return std::move(out_);
  }

 private:
  static constexpr std::size_t kLeastSteps = 64;  ///< of the reduced chain: it bends between them

  Element motion_of(std::size_t step) const {
    if (edges_[step] != nullptr) return G::from(measured(*edges_[step]));
    const Trajectory& keyframes = problem_.keyframes;
    const Pose motion =
        keyframes[step].world_from_body.inverse() * keyframes[step + 1].world_from_body;
    return G::from({motion, 1.0});
  }

  /// Poses of all keyframes by odometry, centred. Sets the density and the unknown covariance.
  std::vector<Element> integrated() {
    edges_.assign(problem_.keyframes.size() - 1, nullptr);
    for (const Edge& edge : problem_.odometry) edges_[edge.from] = &edge;
    inflation_.assign(edges_.size(), std::numeric_limits<double>::infinity());
    for (const Edge& edge : problem_.odometry) inflation_[edge.from] = 1.0;
    for (const FreedStep& step : freed_) inflation_[step.from] = step.inflation;
    std::vector<Element> out{G::from({Pose{}, 1.0})};
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      out.push_back(G::compose(out.back(), motion_of(k)));
    }
    std::vector<Vector3> positions;
    Vector3 sum = Vector3::Zero();
    for (const Element& each : out) {
      positions.push_back(G::to_scaled_pose(each).pose.translation);
      sum += positions.back();
    }
    const Element shift = G::from({{Rotation::Identity(), -sum / static_cast<double>(out.size())}});
    for (Element& each : out) each = G::compose(shift, each);
    double least = 1e-9;
    for (const std::size_t c : closures_) {
      const Square covariance = inverse_of(G::information(problem_.closures[c], 1.0));
      least = std::max(least, std::sqrt(covariance(0, 0)));
    }
    out_.log_uniform = log_uniform_density<G>(positions, least);
    unknown_ = unknown_covariance<G>(out_.log_uniform);
    return out;
  }

  void mark_nodes() {
    const std::size_t steps = edges_.size();
    for (std::size_t i = 0; i <= kLeastSteps; ++i) is_node_[i * steps / kLeastSteps] = true;
    for (const std::size_t c : closures_) {
      is_node_[problem_.closures[c].from] = is_node_[problem_.closures[c].to] = true;
    }
    for (std::size_t k = 0; k < steps; ++k) {
      if (inflation_[k] != 1.0) is_node_[k] = is_node_[k + 1] = true;
    }
  }

  static ChainStep<G> fresh() {
    const Square zero = Square::Zero();
    return {G::from({Pose{}, 1.0}), zero, zero, zero, zero};
  }

  void append(ChainStep<G>& to, std::size_t step) {
    const Element motion = motion_of(step);
    to.measured = G::compose(to.measured, motion);
    const Square back = G::adjoint(G::inverse(motion));
    const auto move = [&](Square& covariance) {
      covariance = (back * covariance * back.transpose()).eval();
    };
    move(to.translation);
    move(to.rotation);
    if (out_.has_mixed) move(to.mixed);
    if (out_.has_unknown) move(to.unknown);
    if (std::isinf(inflation_[step])) {
      to.unknown += unknown_;
      out_.has_unknown = true;
      return;
    }
    constexpr int kFirst = kTranslation<G>, kLast = G::kDof - kFirst;
    const double variance = inflation_[step] * inflation_[step];
    const Square own = variance * inverse_of(G::information(*edges_[step], 1.0));
    to.translation.template topLeftCorner<kFirst, kFirst>() +=
        own.template topLeftCorner<kFirst, kFirst>();
    to.rotation.template bottomRightCorner<kLast, kLast>() +=
        own.template bottomRightCorner<kLast, kLast>();
    const auto cross = own.template topRightCorner<kFirst, kLast>();
    if (!out_.has_mixed && cross.cwiseAbs().maxCoeff() == 0.0) return;
    out_.has_mixed = true;
    to.mixed.template topRightCorner<kFirst, kLast>() += cross;
    to.mixed.template bottomLeftCorner<kLast, kFirst>() += cross.transpose();
  }

  const Problem& problem_;
  std::span<const std::size_t> closures_;
  std::span<const FreedStep> freed_;
  std::vector<const Edge*> edges_;  ///< of each step; null: no odometry
  std::vector<double> inflation_;   ///< of its deviations; infinity: its motion is unknown
  std::vector<bool> is_node_;
  Square unknown_;
  ReducedChain<G> out_;
};

template <class G>
ReducedChain<G> reduced_chain(const Problem& problem,
                              std::span<const std::size_t> closures,
                              std::span<const FreedStep> freed = {}) {
  return ChainReduction<G>(problem, closures, freed).run();
}

}  // namespace loopbench::methods::consensus
