#include "methods/online/online.hpp"

#include <algorithm>
#include <utility>

#include "datasets/core/polyline.hpp"
#include "methods/online/batch_updates.hpp"
#include "methods/online/replay_run.hpp"

namespace loopbench::methods {
namespace {

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
    Replay record = replay.take_replay();
    std::unique_ptr<const Curve> curve = batch.take_curve();
    if (options_.result == Online::Result::causal) {
      curve = std::make_unique<Polyline>(record.causal);
    } else if (curve == nullptr) {
      curve = std::make_unique<Polyline>(replay.poses());
    }
    report.count("updates", static_cast<double>(record.updates.size()));
    if (batch.declined() > 0) report.count("updates_declined", batch.declined());
    return std::make_unique<ReplayedCurve>(std::move(curve), std::move(record));
  }

 private:
  Online::Options options_;
  std::unique_ptr<const Estimator> method_;
};

}  // namespace

std::unique_ptr<const Estimator> Online::replayed(std::unique_ptr<const Estimator> method) const {
  return std::make_unique<ReplayedMethod>(options_, std::move(method));
}

}  // namespace loopbench::methods
