/// Distributes the closing error of each loop along the loop: the usual baseline.
#pragma once

#include <algorithm>

#include "methods/correctors/anchors.hpp"
#include "methods/correctors/shares.hpp"

namespace loopbench::methods {

/// For a closure a -> b with measured pose X_a L of b and cumulative share w_i (w_a = 0, w_b = 1):
///
///     dR = R_target R_b^T,  o = p_a,  dt = p_target - (dR (p_b - o) + o)
///     R_i' = Exp(w_i Log dR) R_i
///     p_i' = Exp(w_i Log dR) (p_i - o) + o + w_i dt
///
/// The poses after b move rigidly with b. The pivot is the loop's start, so the result does not
/// depend on the world frame. Information matrices are not used.
///
/// Several loops are closed one after the other in the order (to, from). The option `overlap`
/// selects the steps that a loop may change when it overlaps an earlier loop. Anchors are met last
/// (distribute_anchor_errors()), which opens loops that disagree with them.
///
/// Complexity O(keyframes + sum of loop lengths). Source: the rotation part as in Surmann,
/// Nuechter et al. (6D SLAM) and Sprickerhof et al. (ELCH), pivot moved to the loop's start.
class Uniform final : public LoopCorrector {
 public:
  enum class RotationMode { none, slerp };

  struct Options {
    RotationMode rotation = RotationMode::slerp;
    StepWeights weights = StepWeights::index;
    LoopOverlap overlap = LoopOverlap::all;
  };
  explicit Uniform(const Options& options) : options_(options) {}

  bool accepts_anchors() const override { return true; }

  /// Counts: `closures`, `largest_closing_error` [m] over all closures after the last one was
  /// closed. Throws std::runtime_error when closures are not sorted by (to, from) or refer to a
  /// missing keyframe.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(Uniform::RotationMode) {
  return std::array{std::pair{"none", Uniform::RotationMode::none},
                    std::pair{"slerp", Uniform::RotationMode::slerp}};
}

template <class Visit>
void fields(Uniform::Options& o, Visit visit) {
  visit("rotation",
        o.rotation,
        "distribution of the rotation error; none: only positions change; slerp: along the "
        "shortest rotation");
  visit("weights", o.weights, "weights of the steps: equal, duration, distance or rotation angle");
  visit("overlap",
        o.overlap,
        "steps that a loop changes; all: all its steps, which reopens earlier loops it overlaps; "
        "open: only steps that no earlier loop encloses, so every loop stays closed");
}

/// Poses during correction. Those after the last closed loop share one rigid motion, which is
/// applied only when a loop reaches them; otherwise every loop would update the whole tail.
class UniformChain {
 public:
  explicit UniformChain(const Trajectory& keyframes) : poses_(keyframes) {}

  void apply_tail(std::size_t end) {
    for (; applied_ < end; ++applied_) {
      Pose& pose = poses_[applied_].world_from_body;
      pose = normalized(world_from_tail_ * pose);
    }
  }

  void close(const Edge& loop, const std::vector<double>& w, bool with_rotation) {
    apply_tail(loop.to + 1);
    const LoopCorrection correction(pose(loop.from), pose(loop.to), loop, with_rotation);
    for (std::size_t k = 0; k < w.size(); ++k) {
      Pose& at = poses_[loop.from + 1 + k].world_from_body;
      at = correction.moved(w[k], at);
    }
    world_from_tail_ = correction.moved(1.0, world_from_tail_);
  }

  Trajectory take() && { return std::move(poses_); }

 private:
  const Pose& pose(std::size_t i) const { return poses_[i].world_from_body; }

  Trajectory poses_;
  Pose world_from_tail_;
  std::size_t applied_ = 0;
};

inline Trajectory Uniform::correct(const Problem& problem, Report& report) const {
  check_closures(problem, "uniform");
  const std::vector<double> shares = step_weights(problem.keyframes, options_.weights);
  std::vector<bool> frozen(problem.keyframes.size(), false);
  UniformChain chain(problem.keyframes);
  std::size_t fallbacks = 0, skipped = 0, scaled = 0;
  for (const Edge& loop : problem.closures) {
    scaled += loop.scale != 1.0 ? 1 : 0;
    const auto w = loop_shares(shares, frozen, loop);
    if (!w) {
      ++skipped;
      continue;
    }
    fallbacks += w->used_equal_shares ? 1 : 0;
    chain.close(loop, w->cumulative, options_.rotation == RotationMode::slerp);
    if (options_.overlap == LoopOverlap::open) {
      const auto first = frozen.begin() + static_cast<std::ptrdiff_t>(loop.from + 1);
      std::fill_n(first, w->cumulative.size(), true);
    }
  }
  chain.apply_tail(problem.keyframes.size());

  Trajectory out = std::move(chain).take();
  distribute_anchor_errors(out, problem, shares, report);
  report_closing_errors(problem, out, report);
  const auto remark = [&](std::size_t count, const std::string& what) {
    if (count > 0) report.notes.push_back(std::to_string(count) + " closures: " + what);
  };
  remark(fallbacks, to_text(options_.weights) + " is zero along the loop, distributed by index");
  remark(skipped, "ignored, every step lies inside an earlier loop");
  remark(scaled, "scale change ignored");
  return out;
}

}  // namespace loopbench::methods
