#include "metrics/loop_detection.hpp"

#include <algorithm>
#include <stdexcept>

#include "datasets/core/polyline.hpp"
#include "metrics/angle.hpp"

namespace loopbench {
namespace {

struct Detection {
  double score = 0.0;
  bool right = false;
  bool accepted = false;
};

/// The reference at the keyframes; nothing where it does not reach.
std::vector<std::optional<Pose>> truth_of(const Trajectory& keyframes,
                                          const Trajectory& reference,
                                          double offset) {
  std::vector<std::optional<Pose>> out(keyframes.size());
  const Polyline curve(reference);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const double stamp = keyframes[i].stamp - offset;
    if (stamp < reference.front().stamp || stamp > reference.back().stamp) continue;
    out[i] = curve.sample({stamp}).front().world_from_body;
  }
  return out;
}

class Judge {
 public:
  Judge(const Problem& problem,
        const Trajectory& reference,
        double offset,
        const LoopDetectionOptions& options)
      : problem_(problem),
        truth_(truth_of(problem.keyframes, reference, offset)),
        options_(options) {}

  bool known(std::size_t i) const { return truth_[i].has_value(); }

  bool same_place(std::size_t from, std::size_t to) const {
    if (!known(from) || !known(to)) return false;
    const double gap = problem_.keyframes[to].stamp - problem_.keyframes[from].stamp;
    return gap >= options_.min_gap &&
           is_close(*truth_[from], *truth_[to], options_.radius, options_.angle / kDegrees);
  }

  bool revisit(std::size_t to) const {
    for (std::size_t from = 0; from < to; ++from) {
      if (same_place(from, to)) return true;
    }
    return false;
  }

  bool wrong(const Edge& edge) const {
    if (!known(edge.from) || !known(edge.to)) return false;
    const Pose truth = truth_[edge.from]->inverse() * *truth_[edge.to];
    return !is_close(
        truth, edge.from_from_to, options_.wrong_metres, options_.wrong_degrees / kDegrees);
  }

 private:
  const Problem& problem_;
  std::vector<std::optional<Pose>> truth_;
  const LoopDetectionOptions& options_;
};

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Detections from the surest down, those of one score together.
void add_curve(std::vector<Detection> all, std::size_t revisits, std::vector<Score>& out) {
  std::ranges::stable_sort(all, std::greater{}, &Detection::score);
  double average = 0.0;
  double full = 0.0;
  std::vector<double> best(11, 0.0);  // precision at recall k / 10 or more
  std::size_t right = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].right) ++right;
    if (i + 1 < all.size() && all[i + 1].score == all[i].score) continue;
    const double precision = share(right, i + 1);
    const double recall = share(right, revisits);
    std::size_t before = 0;  // right ones above this score
    for (std::size_t k = 0; k <= i && all[k].score > all[i].score; ++k) before += all[k].right;
    average += precision * (recall - share(before, revisits));
    if (right == i + 1) full = recall;
    for (std::size_t k = 0; k < best.size(); ++k) {
      if (10 * right >= k * revisits) best[k] = std::max(best[k], precision);
    }
  }
  out.push_back(single("average_precision", "", "1", average));
  out.push_back(single("full_precision_recall", "", "1", full));
  for (std::size_t k = 1; k < best.size(); ++k) {
    const std::string axis = k == 10 ? "recall 1.0" : "recall 0." + std::to_string(k);
    out.push_back(single("precision_at", axis, "1", best[k]));
  }
}

}  // namespace

std::vector<Score> loop_detection(const Evaluation& evaluation,
                                  const LoopDetectionOptions& options) {
  const Context& context = evaluation.context;
  const Problem& problem = needed(context.problem, "loop_detection", "keyframes");
  const Trajectory& reference = needed(context.reference, "loop_detection", "the whole reference");
  const auto& candidates =
      needed(context.loop_candidates, "loop_detection", "candidates of a place recogniser");
  if (candidates.empty()) {
    throw std::runtime_error("loop_detection: no place recogniser ran on this sequence");
  }
  const Judge judge(problem, reference, context.protocol.offset, options);
  std::size_t revisits = 0;
  for (std::size_t to = 0; to < problem.keyframes.size(); ++to) revisits += judge.revisit(to);
  if (revisits == 0) throw std::runtime_error("loop_detection: the reference revisits no place");

  std::vector<Detection> detections;
  std::size_t accepted = 0;
  std::size_t right = 0;
  for (const LoopCandidate& candidate : candidates) {
    if (!judge.known(candidate.from) || !judge.known(candidate.to)) continue;
    const bool same = judge.same_place(candidate.from, candidate.to);
    detections.push_back({candidate.score, same, candidate.accepted});
    accepted += candidate.accepted;
    right += candidate.accepted && same;
  }
  std::size_t wrong = 0;
  for (const Edge& edge : problem.closures) wrong += judge.wrong(edge);

  std::vector<Score> out;
  add_curve(std::move(detections), revisits, out);
  out.push_back(single("precision", "", "1", accepted == 0 ? 1.0 : share(right, accepted)));
  out.push_back(single("recall", "", "1", share(right, revisits)));
  out.push_back(single("revisits", "", "1", static_cast<double>(revisits)));
  out.push_back(single("accepted", "", "1", static_cast<double>(accepted)));
  out.push_back(single("false_closures", "", "1", static_cast<double>(wrong)));
  return out;
}

}  // namespace loopbench
