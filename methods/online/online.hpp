/// Replays a problem: a method gets its data in the order of time, and its answers are recorded.
#pragma once

#include <algorithm>
#include <utility>

#include "datasets/core/polyline.hpp"
#include "methods/method.hpp"
#include "methods/online/batch_updates.hpp"
#include "methods/online/replay_run.hpp"

namespace loopbench::methods {

/// Keyframes and odometry arrive at the stamps of the keyframes, closures as in closure_arrivals().
/// The method is called when closures have arrived or were withdrawn, at the next keyframe; between
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

/// The last curve of a replay, with its record.
class ReplayedCurve final : public Curve {
 public:
  ReplayedCurve(std::unique_ptr<const Curve> curve, Replay replay)
      : curve_(std::move(curve)), replay_(std::move(replay)) {}

  double start() const override { return curve_->start(); }
  double end() const override { return curve_->end(); }
  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    curve_->sample(times, poses);
  }
  const Replay* replay() const override { return &replay_; }

 private:
  std::unique_ptr<const Curve> curve_;
  Replay replay_;
};

class ReplayedMethod final : public Estimator {
 public:
  ReplayedMethod(const Online::Options& options, std::unique_ptr<const Estimator> method)
      : options_(options), method_(std::move(method)) {}

  std::string why_declined(const Problem& problem) const override {
    return method_->why_declined(problem);
  }

  std::unique_ptr<const Curve> estimate(const Problem& problem, Report& report) const override {
    std::unique_ptr<Incremental> incremental = method_->incremental(problem.planar);
    BatchUpdates batch(*method_, problem.planar, options_.warm);
    const bool is_batch = incremental == nullptr;
    const std::vector<Arrival> arrivals = closure_arrivals(problem, options_.arrivals);
    auto every = static_cast<std::size_t>(options_.every);
    if (const auto most = static_cast<std::size_t>(options_.max_updates); most > 0) {
      every = std::max(every, (arrivals.size() + most - 1) / most);
    }
    ReplayRun replay(problem, is_batch ? batch : *incremental, every, report);
    replay.run(arrivals);
    // The last update has all data: the method declines the complete problem.
    if (batch.declined_by()) throw Declined(*batch.declined_by());
    Replay record = replay.take_replay();
    std::unique_ptr<const Curve> curve = batch.take_curve();
    if (options_.result == Online::Result::causal) {
      curve = std::make_unique<Polyline>(record.causal);
    } else if (curve == nullptr) {
      curve = std::make_unique<Polyline>(replay.poses());
    }
    if (!is_batch && options_.warm) {
      report.notes.emplace_back("warm has no effect: the method extends its last solution itself");
    }
    report.count("updates", static_cast<double>(record.updates.size()));
    if (batch.declined() > 0) report.count("updates_declined", batch.declined());
    return std::make_unique<ReplayedCurve>(std::move(curve), std::move(record));
  }

 private:
  Online::Options options_;
  std::unique_ptr<const Estimator> method_;
};

inline std::unique_ptr<const Estimator> Online::replayed(
    std::unique_ptr<const Estimator> method) const {
  return std::make_unique<ReplayedMethod>(options_, std::move(method));
}

}  // namespace loopbench::methods
