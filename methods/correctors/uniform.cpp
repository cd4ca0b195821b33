#include "methods/correctors/uniform.hpp"

#include <algorithm>

#include "methods/correctors/anchors.hpp"

namespace loopbench::methods {
namespace {

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

}  // namespace

Trajectory Uniform::correct(const Problem& problem, Report& report) const {
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
  spread_to_anchors(out, problem, shares, report);
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
