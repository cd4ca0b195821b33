#include <algorithm>
#include <loopbench/datasets/core/interpolate.hpp>
#include <loopbench/datasets/core/polyline.hpp>
#include <loopbench/plugin.hpp>
#include <stdexcept>

using namespace loopbench;
using namespace loopbench::methods;
using namespace loopbench::metrics;

namespace {

/// An external corrector: moves the end of the last closure towards its measured position.
class HalfWay final : public Corrector {
 public:
  struct Options {
    double share = 0.5;
  };
  explicit HalfWay(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override {
    if (problem.closures.empty()) return "no closure to go half way to";
    return "";
  }

  Trajectory correct(const Problem& problem, Report& report) const override {
    Trajectory out = problem.keyframes;
    const Edge& last = problem.closures.back();
    Pose& end = out[last.to].world_from_body;
    const Pose seen = out[last.from].world_from_body * last.from_from_to;
    end = interpolate(end, seen, options_.share);
    report.count("moved", 1.0);
    return out;
  }

 private:
  Options options_;
};

template <class Visit>
void fields(HalfWay::Options& o, Visit visit) {
  visit("share", o.share, "fraction of the gap to close [-]", Between{0.0, 1.0});
}

/// Extends its solution in replays: every keyframe is raised by one metre per closure so far.
class Steps final : public Corrector {
 public:
  using Options = NoOptions;
  explicit Steps(const Options&) {}

  class Updates final : public Incremental {
   public:
    Trajectory update(const Increment& added, Report& report) override {
      tracked_.insert(tracked_.end(), added.keyframes.begin(), added.keyframes.end());
      closures_ += static_cast<double>(added.closures.size());
      report.count("own_updates", ++updates_);
      Trajectory out = tracked_;
      for (StampedPose& pose : out) pose.world_from_body.translation.z() += closures_;
      return out;
    }

   private:
    Trajectory tracked_;
    double closures_ = 0.0;
    double updates_ = 0.0;
  };

  std::unique_ptr<Incremental> incremental(bool) const override {
    return std::make_unique<Updates>();
  }
  Trajectory correct(const Problem& problem, Report& report) const override {
    return Updates().update(complete(problem), report);
  }
};

/// A smoother whose curve type is defined in this shared object.
class Lines final : public Smoother {
 public:
  using Options = NoOptions;
  explicit Lines(const Options&) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return std::make_unique<Polyline>(problem.keyframes);
  }
};

/// Fails on every problem, to test the isolation of cells.
class Thrower final : public Estimator {
 public:
  using Options = NoOptions;
  explicit Thrower(const Options&) {}
  std::unique_ptr<const Curve> estimate(const Problem&, Report&) const override {
    throw std::runtime_error("thrown inside the plugin");
  }
};

/// A dataset: keyframes along x.
struct StraightOptions {
  int keyframes = 5;
};

template <class Visit>
void fields(StraightOptions& o, Visit visit) {
  visit("keyframes", o.keyframes, "number of keyframes", Between{2.0});
}

Sequence load_straight(const StraightOptions& options, const DataRoot&) {
  Sequence out;
  out.name = "straight";
  for (int i = 0; i < options.keyframes; ++i) {
    out.problem.keyframes.push_back({1.0 * i, {Rotation::Identity(), {1.0 * i, 0.1 * i * i, 2.0}}});
  }
  for (std::size_t i = 1; i < out.problem.keyframes.size(); ++i) {
    const Pose step = out.problem.keyframes[i - 1].world_from_body.inverse() *
                      out.problem.keyframes[i].world_from_body;
    out.problem.odometry.push_back({i - 1, i, step, Matrix6::Identity()});
  }
  out.reference = out.problem.keyframes;
  return out;
}

/// A metric of the aligned estimate.
struct MaxHeightOptions {
  double above = 0.0;
};

template <class Visit>
void fields(MaxHeightOptions& o, Visit visit) {
  visit("above", o.above, "height that counts as zero [m]");
}

std::vector<Score> max_height(const Evaluation& evaluation, const MaxHeightOptions& options) {
  double largest = 0.0;
  for (const StampedPose& pose : evaluation.estimate) {
    largest = std::max(largest, pose.world_from_body.translation.z());
  }
  const double height = largest - options.above;
  return {{"height", "z", "m", {1, height, height, height, 0.0, height, height, height * height}}};
}

/// Calls functions of the libraries, which are linked into the plugin.
std::vector<Score> height(const Evaluation& evaluation, const MaxHeightOptions&) {
  std::vector<double> heights;
  for (const StampedPose& pose : evaluation.estimate) {
    heights.push_back(pose.world_from_body.translation.z());
  }
  return {{"height", "z", "m", statistics(heights, evaluation.protocol.ddof)},
          single("top", "z", "m", *std::ranges::max_element(heights))};
}

std::vector<Score> unprintable(const Evaluation&, const MaxHeightOptions&) {
  return {{"\x1b[31m", "z", "m", {}}};
}

}  // namespace

LOOPBENCH_PLUGIN(method<HalfWay>("half_way", "only the closing keyframe moves, and only half"),
                 method<Lines>("lines", "a polyline from outside"),
                 method<Thrower>("thrower", "always fails"),
                 method<Steps>("steps", "one metre higher per closure, extended in replays"),
                 method("lifted",
                        "every keyframe one metre higher",
                        [](const Problem& problem) {
                          Trajectory out = problem.keyframes;
                          for (StampedPose& pose : out) pose.world_from_body.translation.z() += 1;
                          return out;
                        }),
                 dataset<StraightOptions>("straight", "a straight line", load_straight),
                 metric<MaxHeightOptions>("max_height", "largest height", max_height),
                 metric<MaxHeightOptions>("height", "statistics of the heights", height),
                 metric<MaxHeightOptions>("unprintable", "has an invalid name", unprintable))
