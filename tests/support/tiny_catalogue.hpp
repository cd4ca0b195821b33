/// A small catalogue whose results can be computed by hand, and sweeps in the test process.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "datasets/core/polyline.hpp"
#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/model/result.hpp"
#include "harness/sweep/run/run_cell.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"

namespace loopbench {

/// Runs cells one after another: no worker processes, no limits.
inline void run_here(const harness::Sweep& sweep,
                     const std::vector<harness::Cell>& cells,
                     const harness::Catalogue& catalogue,
                     const DataRoot& root,
                     const std::function<void(const harness::CellResult&)>& finished) {
  using Metadata = std::shared_ptr<const harness::SequenceMetadata>;
  std::map<std::pair<std::size_t, int>, std::pair<Sequence, Metadata>> loaded;
  for (const harness::Cell& cell : cells) {
    const std::pair key{cell.dataset, cell.repeat};
    if (!loaded.contains(key)) {
      Sequence sequence = harness::load_sequence(cell, sweep, catalogue, root);
      auto metadata = std::make_shared<const harness::SequenceMetadata>(
          harness::metadata_of(sequence, cell, sweep));
      loaded.emplace(key, std::pair{std::move(sequence), std::move(metadata)});
    }
    const auto& [sequence, metadata] = loaded.at(key);
    harness::CellResult result = harness::run_cell(cell, sweep, sequence, catalogue);
    result.metadata = metadata;
    finished(result);
  }
}

namespace tiny {

using namespace methods;
using namespace metrics;
using namespace harness;

/// Four keyframes 1 s and 1 m apart along x; the estimate is off by `bias` in y at the last one.
struct LineOptions {
  double bias = 0.1;
  std::int64_t seed = 1;
};
template <class Visit>
void fields(LineOptions& o, Visit visit) {
  visit("bias", o.bias, "error of the last keyframe [m]", Between{0.0, 1.0});
  visit("seed", o.seed, "added to the error in micrometres [-]");
}

inline Sequence load_line(const LineOptions& options, const DataRoot&) {
  Sequence out;
  out.name = "line";
  out.provenance.closures = "none";
  for (int i = 0; i < 4; ++i) {
    const Pose pose{Rotation::Identity(), Vector3(i, i * i, 0.0)};
    out.reference.push_back({static_cast<double>(i), pose});
    out.problem.keyframes.push_back({static_cast<double>(i), pose});
  }
  const double tiny = 1e-6 * static_cast<double>(options.seed % 1000);
  out.problem.keyframes.back().world_from_body.translation.y() += options.bias + tiny;
  return out;
}

/// Shifts all poses along z, which alignment removes.
struct Shift final : Corrector {
  struct Options {
    double by = 1.0;
    bool fail = false;
    bool decline = false;
  };
  explicit Shift(const Options& o) : options(o) {}
  std::string why_declined(const Problem&) const override {
    if (options.decline) return "set to decline";
    return "";
  }
  Trajectory correct(const Problem& problem, Report& report) const override {
    if (options.fail) throw std::runtime_error("set to fail");
    report.count("iterations", 3);
    report.sections.push_back(
        {"window", problem.keyframes.front().stamp, problem.keyframes.back().stamp, "shifted"});
    Trajectory out = problem.keyframes;
    for (StampedPose& p : out) p.world_from_body.translation.z() += options.by;
    return out;
  }
  Options options;
};
template <class Visit>
void fields(Shift::Options& o, Visit visit) {
  visit("by", o.by, "along z [m]", Between{-10.0, 10.0});
  visit("fail", o.fail, "throw instead");
  visit("decline", o.decline, "decline instead");
}

struct Straight final : Smoother {
  struct Options {
    double by = 0.0;
  };
  explicit Straight(const Options&) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return std::make_unique<Polyline>(problem.keyframes);
  }
};
template <class Visit>
void fields(Straight::Options& o, Visit visit) {
  visit("by", o.by, "unused, to share a name with shift");
}

struct LengthOptions {
  int power = 1;
};
template <class Visit>
void fields(LengthOptions& o, Visit visit) {
  visit("power", o.power, "of the error", Between{1, 2});
}
inline std::vector<Score> position(const Evaluation& evaluation, const LengthOptions& options) {
  if (options.power == 2) throw std::runtime_error("set to be undefined");
  std::vector<double> errors;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    errors.push_back((evaluation.reference[i].world_from_body.translation -
                      evaluation.estimate[i].world_from_body.translation)
                         .norm());
  }
  return {{"translation", "3d", "m", statistics(errors)}};
}

inline Catalogue catalogue() {
  return {{dataset<LineOptions>("line", "four keyframes", load_line)},
          {method<Shift>("shift", "moves along z"), method<Straight>("straight", "a polyline")},
          {metric<LengthOptions>("ate", "position error", position)}};
}

}  // namespace tiny
}  // namespace loopbench
