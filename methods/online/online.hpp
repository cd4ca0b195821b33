/// Replays a problem: a method gets its data in the order of time, and its answers are recorded.
#pragma once

#include "methods/method.hpp"
#include "methods/online/arrivals.hpp"

namespace loopbench::methods {

/// Keyframes and odometry arrive at the stamps of the keyframes, closures as in arrivals.hpp. The
/// method is called when closures have arrived or were withdrawn, at the next keyframe; between
/// these updates the last solution is extended by odometry. A last update contains what is left, so
/// that the replay ends with the result of the method on the complete problem.
///
/// A method without incremental form solves the problem again at each update (batch_updates.hpp).
/// In addition to the time of the method, an update costs O(keyframes) for the record.
class Online final : public Replayer {
 public:
  /// The curve: the last solution, or the causal trajectory (replay.hpp), interpolated.
  enum class Result { last, causal };
  struct Options {
    ArrivalOptions arrivals;
    std::int64_t every = 1;
    std::int64_t max_updates = 0;
    bool warm = false;
    Result result = Result::last;
  };
  explicit Online(const Options& options) : options_(options) {}

  /// Counts: those of the last update, `updates`, and `updates_declined` if the method declined
  /// some: then the poses were extended by odometry. Phases: sums over the updates.
  std::unique_ptr<const Estimator> replayed(std::unique_ptr<const Estimator> method) const override;

 private:
  Options options_;
};

inline auto choices(Online::Result) {
  return std::array{std::pair{"last", Online::Result::last},
                    std::pair{"causal", Online::Result::causal}};
}

template <class Visit>
void fields(Online::Options& o, Visit visit) {
  fields(o.arrivals, visit);
  visit("every",
        o.every,
        "number of arrivals and withdrawals of closures that start an update",
        Between{1});
  visit(
      "max_updates",
      o.max_updates,
      "maximum number of updates with closures: with more arrivals, `every` is raised; 0: no limit",
      Between{0});
  visit("warm",
        o.warm,
        "a method without incremental form gets the last solution, extended by odometry, as "
        "keyframes (and no frames)");
  visit("result",
        o.result,
        "trajectory that is evaluated: the last solution, or each keyframe at its own time");
}

}  // namespace loopbench::methods
