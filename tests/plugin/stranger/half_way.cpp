#include <stdexcept>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/polyline.hpp"
#include "methods/plugin.hpp"

using namespace loopbench;
using namespace loopbench::methods;

namespace {

/// An external corrector: moves the end of the last closure towards its measured position.
class HalfWay final : public Corrector {
 public:
  struct Options {
    double share = 0.5;
  };
  explicit HalfWay(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override {
    if (problem.closures.empty()) return "no closure to go half way to";
    return std::nullopt;
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

/// A smoother whose curve type is defined in this shared object.
class Lines final : public Smoother {
 public:
  struct Options {};
  explicit Lines(const Options&) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return std::make_unique<Polyline>(problem.keyframes);
  }
};

template <class Visit>
void fields(Lines::Options&, Visit) {}

/// Fails on every problem, to test the isolation of cells.
class Thrower final : public Method {
 public:
  struct Options {};
  explicit Thrower(const Options&) {}
  std::unique_ptr<const Curve> estimate(const Problem&, Report&) const override {
    throw std::runtime_error("thrown inside the plugin");
  }
};

template <class Visit>
void fields(Thrower::Options&, Visit) {}

}  // namespace

LOOPBENCH_PLUGIN(method<HalfWay>("half_way", "only the closing keyframe moves, and only half"),
                 method<Lines>("lines", "a polyline from outside"),
                 method<Thrower>("thrower", "always fails"))
