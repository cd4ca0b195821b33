#include "methods/correctors/consensus/anchor_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "methods/correctors/anchors.hpp"

namespace loopbench::methods::consensus {
namespace {

bool is_dropped_run(const AnchorJudgement& found) { return found.run && !found.run->is_end; }

std::string name_of(const Problem& problem, std::size_t anchor) {
  return problem.name_of(problem.anchors[anchor].keyframe);
}

std::string dropped_anchors_text(const Problem& problem, const AnchorJudgement& found) {
  constexpr std::size_t kMostListed = 5;
  std::vector<std::size_t> dropped;
  for (std::size_t i = 0; i < found.anchors.size(); ++i) {
    const bool is_run = is_dropped_run(found) && i >= found.run->first && i <= found.run->last;
    if (!found.anchors[i].agrees && !is_run) dropped.push_back(i);
  }
  std::ranges::stable_sort(dropped, {}, [&](std::size_t i) { return found.anchors[i].log_odds; });
  std::string out;
  for (std::size_t i = 0; i < std::min(dropped.size(), kMostListed); ++i) {
    out += fmt::format("{}{} ({:.3g} m)",
                       i == 0 ? "" : ", ",
                       name_of(problem, dropped[i]),
                       found.anchors[dropped[i]].metres);
  }
  if (dropped.size() > kMostListed) {
    out += fmt::format(" and {} more", dropped.size() - kMostListed);
  }
  if (!is_dropped_run(found)) return out;
  return out + fmt::format("{}{} from {} to {} that agree with each other ({:.3g} m)",
                           out.empty() ? "" : "; ",
                           found.run->last + 1 - found.run->first,
                           name_of(problem, found.run->first),
                           name_of(problem, found.run->last),
                           found.run->metres);
}

/// A run at the begin or the end, which can be an error of the odometry as well.
std::string end_run_text(const Problem& problem, const AnchorRun& run) {
  const bool is_begin = run.first == 0;
  const std::size_t before = is_begin ? run.last : run.first - 1;
  return fmt::format(
      "the anchors {} {} are shifted by {:.3g} m against those {}, all alike: they or the odometry "
      "between {} and {} are wrong, which closures could decide; neither group is dropped as a "
      "whole",
      is_begin ? "up to" : "from",
      name_of(problem, is_begin ? run.last : run.first) + (is_begin ? "" : " on"),
      run.metres,
      is_begin ? "after" : "before",
      name_of(problem, before),
      name_of(problem, before + 1));
}

/// The first keyframe is held, and the first anchors are off by the same.
std::string held_shift_text(const Problem& problem, const UsedAnchors& used) {
  constexpr std::size_t kFirst = 3;
  constexpr double kLarger = 3.0, kDeviations = 6.0;
  if (used.anchors.size() < kFirst) return "";
  Vector3 mean = Vector3::Zero();
  double variance = 0.0, spread = 0.0;
  const auto error = [&](std::size_t i) -> Vector3 {
    const Anchor& anchor = used.anchors[i];
    return anchor_error(anchor, problem.keyframes[anchor.keyframe].world_from_body);
  };
  for (std::size_t i = 0; i < kFirst; ++i) {
    mean += error(i) / kFirst;
    variance = std::max(variance, used.anchors[i].covariance.trace() / 3.0);
  }
  for (std::size_t i = 0; i < kFirst; ++i) spread += (error(i) - mean).squaredNorm() / kFirst;
  const double squared = mean.squaredNorm();
  if (squared < kLarger * kLarger * spread || squared < kDeviations * kDeviations * variance) {
    return "";
  }
  return fmt::format(
      "the first {} anchors are {:.3g} m from the keyframes, all alike: a shift of the anchors and "
      "drift before the first of them cannot be told apart, because anchors on a line leave the "
      "first keyframe where it is",
      kFirst,
      std::sqrt(squared));
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
  if (found.is_decided && found.run && found.run->is_end) return end_run_text(problem, *found.run);
  Problem frames = problem;
  frames.anchors = used_anchors(problem.anchors, found);
  if (frames.anchors.empty()) return "";
  const UsedAnchors used(frames);
  if (!used.is_first_free) return held_shift_text(problem, used);
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
