#include "methods/correctors/two_pass.hpp"

#include <algorithm>
#include <cmath>

#include "methods/correctors/anchors.hpp"
#include "methods/correctors/chain.hpp"

namespace loopbench::methods {
namespace {

/// Similarity transform x -> scale * rotation * x + translation.
struct Similarity {
  Rotation rotation = Rotation::Identity();
  Vector3 translation = Vector3::Zero();
  double scale = 1.0;

  Pose operator*(const Pose& pose) const {
    return {rotation * pose.rotation, scale * (rotation * pose.translation) + translation};
  }
};

/// Poses during correction. Those after the last closed loop share one similarity transform.
class TwoPassChain {
 public:
  explicit TwoPassChain(const Trajectory& keyframes)
      : poses_(keyframes), scale_(keyframes.size(), 1.0) {}

  void apply_tail(std::size_t end) {
    for (; applied_ < end; ++applied_) {
      Pose& pose = poses_[applied_].world_from_body;
      pose = normalized(tail_ * pose);
      scale_[applied_] = tail_.scale;
    }
  }

  void close(const Edge& loop,
             const std::vector<double>& w,
             const std::vector<double>& v,
             bool scaled) {
    apply_tail(loop.to + 1);
    // The closure measures the scale change of the original chain; earlier loops have already
    // corrected part of it.
    const double scale =
        scaled && states_scale(loop) ? loop.scale * scale_[loop.from] / scale_[loop.to] : 1.0;
    const Pose start = pose(loop.from);
    const Pose old_end = pose(loop.to);
    const Pose target = start * measured(loop);
    const Vector3 phi = log_so3(target.rotation * old_end.rotation.conjugate());

    Vector3 old_before = start.translation;
    Vector3 before = start.translation;
    double share_before = 0.0;
    for (std::size_t k = 0; k < w.size(); ++k) {
      Pose& at = poses_[loop.from + 1 + k].world_from_body;
      const Vector3 old_at = at.translation;
      before += std::pow(scale, share_before) *
                (exp_so3(share_before * phi) * Vector3(old_at - old_before));
      at = normalized(Pose{exp_so3(w[k] * phi) * at.rotation, before});
      old_before = old_at;
      share_before = w[k];
    }
    const Vector3 shift = target.translation - pose(loop.to).translation;
    for (std::size_t k = 0; k < v.size(); ++k) {
      poses_[loop.from + 1 + k].world_from_body.translation += v[k] * shift;
      scale_[loop.from + 1 + k] *= std::pow(scale, w[k]);
    }
    // The poses after the loop keep their pose relative to its end.
    const Rotation rotation = exp_so3(phi);
    const Vector3 end = pose(loop.to).translation;
    tail_ = {(rotation * tail_.rotation).normalized(),
             scale * (rotation * Vector3(tail_.translation - old_end.translation)) + end,
             scale * tail_.scale};
  }

  double gap(const Edge& loop) const {
    return ((pose(loop.from) * measured(loop)).translation - pose(loop.to).translation).norm();
  }

  Trajectory take() && { return std::move(poses_); }

 private:
  const Pose& pose(std::size_t i) const { return poses_[i].world_from_body; }

  /// Measured pose of the closure, in the current scale of the chain at the loop's start.
  Pose measured(const Edge& loop) const {
    return {loop.from_from_to.rotation, scale_[loop.from] * loop.from_from_to.translation};
  }

  Trajectory poses_;
  std::vector<double> scale_;  ///< scale applied to the chain so far, per pose
  Similarity tail_;
  std::size_t applied_ = 0;
};

}  // namespace

Trajectory TwoPass::correct(const Problem& problem, Report& report) const {
  check_closures(problem, "two_pass");
  const Trajectory& keyframes = problem.keyframes;
  const std::vector<double> rotation_shares = step_weights(keyframes, options_.rotation_weights);
  const std::vector<double> translation_shares =
      step_weights(keyframes, options_.translation_weights);
  std::vector<bool> frozen(keyframes.size(), false);
  TwoPassChain chain(keyframes);
  std::size_t skipped = 0;
  for (const Edge& loop : problem.closures) {
    const auto w = loop_shares(rotation_shares, frozen, loop);
    const auto v = loop_shares(translation_shares, frozen, loop);
    if (!w || !v) {
      ++skipped;
      continue;
    }
    chain.close(loop, w->cumulative, v->cumulative, options_.scale);
    if (options_.overlap == LoopOverlap::open) {
      const auto first = frozen.begin() + static_cast<std::ptrdiff_t>(loop.from + 1);
      std::fill_n(first, w->cumulative.size(), true);
    }
  }
  chain.apply_tail(keyframes.size());

  double gap = 0.0;
  for (const Edge& loop : problem.closures) gap = std::max(gap, chain.gap(loop));
  report.count("closures", static_cast<double>(problem.closures.size()));
  report.count("largest_closing_error", gap);
  if (skipped > 0) {
    report.notes.push_back(std::to_string(skipped) +
                           " closures ignored: every step lies inside an earlier loop");
  }
  Trajectory out = std::move(chain).take();
  distribute_anchor_errors(out, problem, translation_shares, report);
  return out;
}

}  // namespace loopbench::methods
