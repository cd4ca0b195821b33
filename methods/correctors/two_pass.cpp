#include "methods/correctors/two_pass.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench {
namespace {

/// x -> scale * rotation * x + translation.
struct Similarity {
  Rotation rotation = Rotation::Identity();
  Vector3 translation = Vector3::Zero();
  double scale = 1.0;

  Pose operator*(const Pose& pose) const {
    return {rotation * pose.rotation, scale * (rotation * pose.translation) + translation};
  }
};

/// Poses being corrected; those after the last closed loop share one similarity.
class BentChain {
 public:
  explicit BentChain(const Trajectory& keyframes)
      : poses_(keyframes), unit_(keyframes.size(), 1.0) {}

  void settle(std::size_t end) {
    for (; settled_ < end; ++settled_) {
      Pose& pose = poses_[settled_].world_from_body;
      pose = normalized(tail_ * pose);
      unit_[settled_] = tail_.scale;
    }
  }

  void close(const Edge& loop,
             const std::vector<double>& w,
             const std::vector<double>& v,
             bool scaled) {
    settle(loop.to + 1);
    // What the loop says of the unit is of the chain as measured; loops before have done their
    // part.
    const double scale = scaled ? loop.scale * unit_[loop.from] / unit_[loop.to] : 1.0;
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
      unit_[loop.from + 1 + k] *= std::pow(scale, w[k]);
    }
    // The tail keeps its place relative to the loop's end: from old_end to the corrected one.
    const Rotation turn = exp_so3(phi);
    const Vector3 end = pose(loop.to).translation;
    tail_ = {(turn * tail_.rotation).normalized(),
             scale * (turn * Vector3(tail_.translation - old_end.translation)) + end,
             scale * tail_.scale};
  }

  double gap(const Edge& loop) const {
    return ((pose(loop.from) * measured(loop)).translation - pose(loop.to).translation).norm();
  }

  Trajectory take() && { return std::move(poses_); }

 private:
  const Pose& pose(std::size_t i) const { return poses_[i].world_from_body; }

  /// In the unit that the chain has at the loop's start by now.
  Pose measured(const Edge& loop) const {
    return {loop.from_from_to.rotation, unit_[loop.from] * loop.from_from_to.translation};
  }

  Trajectory poses_;
  std::vector<double> unit_;  ///< by how much the chain has been stretched at each pose
  Similarity tail_;
  std::size_t settled_ = 0;
};

}  // namespace

std::optional<std::string> TwoPass::declines(const Problem& problem) const {
  if (problem.closures.empty()) return "no loop closure to spread";
  return std::nullopt;
}

Trajectory TwoPass::correct(const Problem& problem, Report& report) const {
  check_closures(problem, "two_pass");
  const Trajectory& keyframes = problem.keyframes;
  const std::vector<double> turns = step_shares(keyframes, options_.rotation_weights);
  const std::vector<double> shifts = step_shares(keyframes, options_.translation_weights);
  std::vector<bool> frozen(keyframes.size(), false);
  BentChain chain(keyframes);
  std::size_t skipped = 0;
  for (const Edge& loop : problem.closures) {
    const auto w = loop_shares(turns, frozen, loop);
    const auto v = loop_shares(shifts, frozen, loop);
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
  chain.settle(keyframes.size());

  double gap = 0.0;
  for (const Edge& loop : problem.closures) gap = std::max(gap, chain.gap(loop));
  report.count("closures", static_cast<double>(problem.closures.size()));
  report.count("largest_gap_left", gap);
  if (skipped > 0) {
    report.notes.push_back(std::to_string(skipped) +
                           " closures: every step lies inside an earlier loop, left as it was");
  }
  return std::move(chain).take();
}

}  // namespace loopbench
