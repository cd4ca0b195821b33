#include "methods/correctors/uniform.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace loopbench {
namespace {

using Weights = Uniform::Weights;

/// shares[i] >= 0 belongs to the step from keyframe i - 1 to i; shares[0] is not used.
std::vector<double> step_shares(const Trajectory& keyframes, Weights weights) {
  std::vector<double> shares(keyframes.size(), 1.0);
  if (weights == Weights::index) return shares;
  for (std::size_t i = 1; i < keyframes.size(); ++i) {
    const auto& [before, a] = keyframes[i - 1];
    const auto& [stamp, b] = keyframes[i];
    shares[i] = weights == Weights::time       ? stamp - before
                : weights == Weights::distance ? (b.translation - a.translation).norm()
                                               : angle_between(a.rotation, b.rotation);
  }
  return shares;
}

/// Cumulative shares over (from, to]; out.back() is exactly 1. Empty when every step is frozen.
std::vector<double> cumulative(const std::vector<double>& shares,
                               const std::vector<bool>& frozen,
                               const Edge& loop,
                               bool& fell_back) {
  std::vector<double> out(loop.to - loop.from);
  const auto accumulate = [&](auto share_of) {
    double sum = 0.0;
    for (std::size_t k = 0; k < out.size(); ++k) {
      const std::size_t i = loop.from + 1 + k;
      out[k] = sum += frozen[i] ? 0.0 : share_of(i);
    }
    return sum;
  };
  double total = accumulate([&](std::size_t i) { return shares[i]; });
  if (!(total > 0.0)) {  // standing still, or not turning: nothing to be proportional to
    total = accumulate([](std::size_t) { return 1.0; });
    if (total == 0.0) return {};
    fell_back = true;
  }
  for (double& w : out) w /= total;
  return out;
}

/// Poses being corrected. Those after the last closed loop share one rigid motion, which is
/// applied when a loop reaches them: otherwise every loop would touch the whole tail.
class Chain {
 public:
  explicit Chain(const Trajectory& keyframes) : poses_(keyframes) {}

  void settle(std::size_t end) {
    for (; settled_ < end; ++settled_) {
      Pose& pose = poses_[settled_].world_from_body;
      pose = normalized(world_from_tail_ * pose);
    }
  }

  void close(const Edge& loop, const std::vector<double>& w, bool turn) {
    settle(loop.to + 1);
    const Pose target = pose(loop.from) * loop.from_from_to;
    const Pose end = pose(loop.to);
    const Vector3 pivot = pose(loop.from).translation;
    const Vector3 phi =
        turn ? log_so3(target.rotation * end.rotation.conjugate()) : Vector3(Vector3::Zero());
    const Vector3 shift = target.translation - (exp_so3(phi) * (end.translation - pivot) + pivot);
    const auto moved = [&](double share, const Pose& before) {
      const Rotation part = exp_so3(share * phi);
      return normalized(
          {part * before.rotation, part * (before.translation - pivot) + pivot + share * shift});
    };
    for (std::size_t k = 0; k < w.size(); ++k) {
      Pose& at = poses_[loop.from + 1 + k].world_from_body;
      at = moved(w[k], at);
    }
    world_from_tail_ = moved(1.0, world_from_tail_);
  }

  double gap(const Edge& loop) const {
    return ((pose(loop.from) * loop.from_from_to).translation - pose(loop.to).translation).norm();
  }

  Trajectory take() && { return std::move(poses_); }

 private:
  const Pose& pose(std::size_t i) const { return poses_[i].world_from_body; }

  Trajectory poses_;
  Pose world_from_tail_;
  std::size_t settled_ = 0;
};

}  // namespace

std::optional<std::string> Uniform::declines(const Problem& problem) const {
  if (problem.closures.empty()) return "no loop closure to spread";
  return std::nullopt;
}

Trajectory Uniform::correct(const Problem& problem, Report& report) const {
  const std::vector<Edge>& loops = problem.closures;
  const auto order = [](const Edge& loop) { return std::tuple(loop.to, loop.from); };
  const auto sound = [&](const Edge& loop) {
    return loop.from < loop.to && loop.to < problem.keyframes.size();
  };
  if (!std::ranges::is_sorted(loops, {}, order) || !std::ranges::all_of(loops, sound)) {
    throw std::runtime_error("uniform: closures must name keyframes and be sorted by (to, from)");
  }
  const std::vector<double> shares = step_shares(problem.keyframes, options_.weights);
  std::vector<bool> frozen(problem.keyframes.size(), false);
  Chain chain(problem.keyframes);
  std::size_t fallbacks = 0, skipped = 0, scaled = 0;
  for (const Edge& loop : loops) {
    bool fell_back = false;
    const std::vector<double> w = cumulative(shares, frozen, loop, fell_back);
    fallbacks += fell_back ? 1 : 0;
    skipped += w.empty() ? 1 : 0;
    scaled += loop.scale != 1.0 ? 1 : 0;
    if (!w.empty()) chain.close(loop, w, options_.rotation == Turn::slerp);
    if (options_.overlap == Overlap::open) {
      std::fill_n(frozen.begin() + static_cast<std::ptrdiff_t>(loop.from + 1), w.size(), true);
    }
  }
  chain.settle(problem.keyframes.size());

  double gap = 0.0;
  for (const Edge& loop : loops) gap = std::max(gap, chain.gap(loop));
  report.count("closures", static_cast<double>(loops.size()));
  report.count("largest_gap_left", gap);
  const auto remark = [&](std::size_t count, const std::string& what) {
    if (count > 0) report.notes.push_back(std::to_string(count) + " closures: " + what);
  };
  remark(fallbacks, to_text(options_.weights) + " is zero along the loop, spread by index");
  remark(skipped, "every step lies inside an earlier loop, left as it was");
  remark(scaled, "their change of scale is ignored");
  return std::move(chain).take();
}

}  // namespace loopbench
