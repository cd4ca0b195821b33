/// Runs any corrector on the pairwise consistent loop closures only.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "datasets/core/error.hpp"
#include "methods/correctors/chain.hpp"
#include "methods/correctors/consistency.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

template <class Base>
struct PairwiseConsistentOptions {
  typename Base::Options base = {};
  std::int64_t max_closures = kMaxComparedClosures;
};

template <class Base, class Visit>
void fields(PairwiseConsistentOptions<Base>& o, Visit visit) {
  fields(o.base, visit);
  visit("pcm.max_closures",
        o.max_closures,
        "maximum number of closures; all pairs are compared",
        Between{1});
}

/// Runs consistent_closures(), then `Base` on the remaining closures. Returns the keyframes
/// unchanged when no two closures agree and there are no anchors. Frames are not passed on.
template <class Base>
class PairwiseConsistent final : public Corrector {
 public:
  using Options = PairwiseConsistentOptions<Base>;
  explicit PairwiseConsistent(const Options& options)
      : max_closures_(options.max_closures), base_(options.base) {}

  std::string why_declined(const Problem& problem) const override {
    if (problem.closures.empty()) return "the problem has no loop closures";
    std::string fault = loops_fault(problem, max_closures_, "pcm.max_closures");
    if (!fault.empty()) return fault;
    // What the base declines with a single closure, it declines with any of them.
    return base_.why_declined(
        {problem.keyframes, problem.odometry, {problem.closures.front()}, {}, problem.planar});
  }

  bool accepts_anchors() const override { return base_.accepts_anchors(); }

  /// Counts: those of `Base`, and `closures_consistent`. Throws Declined if `Base` declines the
  /// remaining closures, and what `Base` throws.
  Trajectory correct(const Problem& problem, Report& report) const override {
    Problem reduced{problem.keyframes, problem.odometry, {}, {}, problem.planar};
    reduced.anchors = problem.anchors;
    reduced.ids = problem.ids;
    const ConsistentClosures found =
        report.time("check", [&] { return consistent_closures(problem); });
    for (const std::size_t k : found.kept) reduced.closures.push_back(problem.closures[k]);
    report.count("closures_consistent", static_cast<double>(found.kept.size()));
    std::vector<std::size_t> rejected;
    for (std::size_t k = 0; k < problem.closures.size(); ++k) {
      if (!std::ranges::binary_search(found.kept, k)) rejected.push_back(k);
    }
    report.rejected = rejected;
    if (problem.closures.size() == 1) report.notes.emplace_back(kOneClosure);
    if (2 * found.kept.size() < problem.closures.size() && !found.kept.empty()) {
      report.notes.push_back("only " + std::to_string(found.kept.size()) + " of " +
                             std::to_string(problem.closures.size()) +
                             " closures are pairwise consistent");
    }
    if (!found.is_largest) {
      report.notes.push_back("the search for the largest consistent set was not finished");
    }
    if (reduced.closures.empty() && reduced.anchors.empty()) {
      report.notes.push_back("no two closures are consistent: keyframes returned unchanged");
      return problem.keyframes;
    }
    if (const std::string why = base_.why_declined(reduced); !why.empty()) {
      throw Declined(why);
    }
    report.rejected.reset();
    Trajectory out = base_.correct(reduced, report);
    for (const std::size_t k : report.rejected.value_or(std::vector<std::size_t>{})) {
      rejected.push_back(found.kept[k]);
    }
    std::ranges::sort(rejected);
    report.rejected = std::move(rejected);
    return out;
  }

 private:
  std::int64_t max_closures_;
  Base base_;
};

}  // namespace loopbench::methods
