#include "metrics/correction/loop_detection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "datasets/core/interpolate.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

struct Scored {
  double score = 0.0;
  bool right = false;
};

/// Reference poses at the keyframes; nullopt outside the reference.
std::vector<std::optional<Pose>> truth_of(const Trajectory& keyframes,
                                          const Trajectory& reference) {
  std::vector<std::optional<Pose>> out(keyframes.size());
  constexpr double kAnyGap = std::numeric_limits<double>::infinity();
  std::size_t after = 0;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    out[i] = pose_at(reference, keyframes[i].stamp, kAnyGap, after);
  }
  return out;
}

/// Pairs of keyframes according to the reference.
class ClosureTruth {
 public:
  ClosureTruth(const Problem& problem, const Trajectory& reference, const DetectionRule& options)
      : problem_(problem), truth_(truth_of(problem.keyframes, reference)), options_(options) {}

  bool is_known(std::size_t i) const { return truth_[i].has_value(); }

  bool is_same_place(std::size_t from, std::size_t to) const {
    if (!is_known(from) || !is_known(to)) return false;
    const double gap = problem_.keyframes[to].stamp - problem_.keyframes[from].stamp;
    return gap >= options_.min_gap &&
           is_close(*truth_[from], *truth_[to], options_.radius, options_.angle / kDegrees);
  }

  bool is_revisit(std::size_t to) const {
    for (std::size_t from = 0; from < to; ++from) {
      if (is_same_place(from, to)) return true;
    }
    return false;
  }

  bool is_wrong(const Edge& edge) const {
    if (!is_known(edge.from) || !is_known(edge.to)) return false;
    const Pose truth = truth_[edge.from]->inverse() * *truth_[edge.to];
    return !is_close(
        truth, edge.from_from_to, options_.wrong_metres, options_.wrong_degrees / kDegrees);
  }

 private:
  const Problem& problem_;
  std::vector<std::optional<Pose>> truth_;
  const DetectionRule& options_;
};

double share(std::size_t part, std::size_t all) {
  return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
}

/// In descending order of score; visits equal scores together.
void add_curve(std::vector<Scored> all, Detection& out) {
  std::ranges::stable_sort(all, std::greater{}, &Scored::score);
  std::size_t right = 0;
  double recall_before = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].right) ++right;
    if (i + 1 < all.size() && all[i + 1].score == all[i].score) continue;
    const double precision = share(right, i + 1);
    const double recall = share(right, out.revisits);
    out.average_precision += precision * (recall - recall_before);
    recall_before = recall;
    if (right == i + 1) out.full_precision_recall = recall;
    for (std::size_t k = 0; k < out.precision_at.size(); ++k) {
      double& best = out.precision_at[k];
      if (10 * right >= (k + 1) * out.revisits) best = std::max(best, precision);
    }
  }
}

}  // namespace

Detection evaluate_detection(const Problem& problem,
                             const Trajectory& reference,
                             const std::vector<LoopCandidate>& candidates,
                             const DetectionRule& rule) {
  if (reference.empty()) throw std::runtime_error("loop detection: needs a reference");
  const ClosureTruth truth(problem, reference, rule);
  Detection out;
  for (std::size_t to = 0; to < problem.keyframes.size(); ++to) {
    if (truth.is_revisit(to)) ++out.revisits;
  }
  std::vector<Scored> scored;
  std::size_t right = 0;
  for (const LoopCandidate& candidate : candidates) {
    if (!truth.is_known(candidate.from) || !truth.is_known(candidate.to)) continue;
    const bool same = truth.is_same_place(candidate.from, candidate.to);
    scored.push_back({candidate.score, same});
    if (!candidate.accepted) continue;
    ++out.accepted;
    if (same) ++right;
  }
  for (const Edge& edge : problem.closures) {
    if (truth.is_wrong(edge)) ++out.wrong_pose;
  }
  if (out.accepted > 0) out.precision = share(right, out.accepted);
  if (out.revisits == 0) return out;
  out.recall = share(right, out.revisits);
  add_curve(std::move(scored), out);
  return out;
}

std::string to_text(const Detection& d) {
  std::string curve;
  for (const double precision : d.precision_at) curve += fmt::format(" {:.2f}", precision);
  return fmt::format(
      "loop detection: {} revisits, {} closures, {} with a false pose; precision {:.3f}, recall "
      "{:.3f}; average precision {:.3f}, recall at full precision {:.3f}; precision at recall "
      "0.1 .. 1.0:{}",
      d.revisits,
      d.accepted,
      d.wrong_pose,
      d.precision,
      d.recall,
      d.average_precision,
      d.full_precision_recall,
      curve);
}

std::vector<Score> loop_detection(const Evaluation& evaluation, const DetectionRule& rule) {
  const Context& context = evaluation.context;
  const auto& candidates = needed(context.loop_candidates, "loop candidates");
  if (candidates.empty()) {
    throw Undefined("no loop candidates; only image sequences with place recognition have them");
  }
  const Trajectory& reference = needed(context.reference, "a reference");
  if (reference.empty()) throw Undefined("needs a reference");
  const Detection d =
      evaluate_detection(needed(context.problem, "keyframes"), reference, candidates, rule);
  if (d.revisits == 0) throw Undefined("the reference revisits no place");
  const auto whole = [](const char* what, std::size_t count) {
    return directed(single(what, "", "1", static_cast<double>(count)), Better::neither);
  };
  const auto quality = [](const char* what, const std::string& axis, double value) {
    return directed(single(what, axis, "1", value), Better::higher);
  };
  std::vector<Score> out{whole("revisits", d.revisits),
                         whole("closures", d.accepted),
                         whole("false_poses", d.wrong_pose),
                         quality("precision", "", d.precision),
                         quality("recall", "", d.recall),
                         quality("average_precision", "", d.average_precision),
                         quality("full_precision_recall", "", d.full_precision_recall)};
  for (std::size_t k = 0; k < d.precision_at.size(); ++k) {
    out.push_back(quality("precision_at_recall",
                          fmt::format("{:.1f}", 0.1 * static_cast<double>(k + 1)),
                          d.precision_at[k]));
  }
  return out;
}

}  // namespace loopbench::metrics
