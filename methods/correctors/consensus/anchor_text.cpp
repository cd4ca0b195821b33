#include "methods/correctors/consensus/anchor_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "methods/correctors/anchors.hpp"

namespace loopbench::methods::consensus {
namespace {

std::string dropped_anchors_text(const Problem& problem, const AnchorJudgement& found) {
  constexpr std::size_t kMostListed = 5;
  std::vector<std::size_t> dropped;
  for (std::size_t i = 0; i < found.anchors.size(); ++i) {
    if (!found.anchors[i].agrees) dropped.push_back(i);
  }
  std::ranges::stable_sort(dropped, {}, [&](std::size_t i) { return found.anchors[i].log_odds; });
  std::string out;
  for (std::size_t i = 0; i < std::min(dropped.size(), kMostListed); ++i) {
    out += fmt::format("{}{} ({:.3g} m)",
                       i == 0 ? "" : ", ",
                       problem.name_of(problem.anchors[dropped[i]].keyframe),
                       found.anchors[dropped[i]].metres);
  }
  if (dropped.size() <= kMostListed) return out;
  return out + fmt::format(" and {} more", dropped.size() - kMostListed);
}

}  // namespace

std::string anchors_text(const Problem& problem, const AnchorJudgement& found) {
  const std::size_t all = found.anchors.size();
  if (!found.is_decided) {
    return fmt::format(
        "no anchor is used: {} of {} agree with each other, log odds {:.3g}; more than half, and "
        "odds of ln 100 = 4.6 would decide (pose_graph uses all)",
        found.agreeing,
        all,
        found.evidence);
  }
  if (found.agreeing == all) {
    return all == 1 ? "the anchor agrees" : fmt::format("all {} anchors agree", all);
  }
  return fmt::format(
      "{} of {} anchors are used; dropped, with the distance from what the others predict: {}",
      found.agreeing,
      all,
      dropped_anchors_text(problem, found));
}

std::string datum_shift_text(const Problem& problem, const AnchorJudgement& found) {
  constexpr double kLarger = 3.0;
  Problem frames = problem;
  frames.anchors = used_anchors(problem.anchors, found);
  if (frames.anchors.empty()) return "";
  const UsedAnchors used(frames);
  if (!used.is_first_free) return "";
  const Pose motion = used.alignment(problem.keyframes);
  double before = 0.0, after = 0.0;
  Vector3 centre = Vector3::Zero();
  for (const Anchor& anchor : used.anchors) {
    const Pose& pose = problem.keyframes[anchor.keyframe].world_from_body;
    before += anchor_error(anchor, pose).squaredNorm();
    after += anchor_error(anchor, motion * pose).squaredNorm();
    centre += pose.translation / static_cast<double>(used.anchors.size());
  }
  if (!(before > kLarger * kLarger * after)) return "";
  return fmt::format(
      "the anchors are shifted against the keyframes by {:.3g} m and {:.3g} degrees, "
      "all by the same motion: the result is in their frame",
      (motion * centre - centre).norm(),
      log_so3(motion.rotation).norm() * 180.0 / M_PI);
}

}  // namespace loopbench::methods::consensus
