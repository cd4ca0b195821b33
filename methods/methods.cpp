#include <algorithm>

#include "datasets/core/error.hpp"
#include "datasets/core/polyline.hpp"
#include "methods/correctors/checked.hpp"
#include "methods/correctors/consensus.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/elch.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/correctors/two_pass.hpp"
#include "methods/correctors/uniform.hpp"
#include "methods/function_method.hpp"
#include "methods/method.hpp"
#include "methods/online/online.hpp"
#include "methods/smoothers/gaussian_process.hpp"
#include "methods/smoothers/interpolating_splines.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "methods/smoothers/smoothing_spline.hpp"
#include "methods/smoothers/tracked_frames.hpp"

namespace loopbench::methods {
namespace {

/// Best variant on training sequences that are not in the article (results/methods/training.md). It
/// fits curves where the speed is steady for a while and straight lines elsewhere. Rotation never
/// ends a segment (no angle exceeds pi), and the spline is used where the nodes do not form a
/// graph.
Dm::Options robust() {
  return {.planar = 5,
          .segment = {.speed_band = 0.1, .turn_max = 10.0},
          .gap = {.time_max = 0.3},
          .fallback = manifold::Fallback::spline,
          .scheme = manifold::Scheme::sliding_blend,
          .short_policy = manifold::ShortPolicy::polyline,
          .min_nodes = 9};
}

/// No correction: the baseline for all gains.
class Raw final : public Corrector {
 public:
  using Options = NoOptions;
  explicit Raw(const Options&) {}
  bool accepts_anchors() const override { return true; }
  Trajectory correct(const Problem& problem, Report&) const override { return problem.keyframes; }
};

/// The baseline smoother.
std::unique_ptr<const Curve> polyline(const Problem& problem) {
  return std::make_unique<Polyline>(problem.keyframes);
}

}  // namespace

std::vector<MethodEntry> methods() {
  return {
      // Correctors: keyframes in, keyframes out.
      method<Raw>("raw", "uncorrected keyframes of the tracker"),
      method<Uniform>("uniform", "closing error distributed evenly along each loop"),
      method<Uniform>("uniform_position",
                      "closing error distributed evenly, positions only",
                      {.rotation = Uniform::RotationMode::none}),
      method<Uniform>("uniform_open",
                      "closing error distributed evenly over steps that no earlier loop encloses",
                      {.overlap = LoopOverlap::open}),
      method<Elch>("elch", "closing error distributed by distance in the pose graph"),
      method<TwoPass>("two_pass",
                      "rotation error distributed and poses re-integrated, then translation"),
      method<TwoPass>("two_pass_open",
                      "two_pass over steps that no earlier loop encloses",
                      {.overlap = LoopOverlap::open}),
      method<TwoPass>("two_pass_motion",
                      "two_pass, weighted by rotation angle and by distance",
                      {.rotation_weights = StepWeights::rotation,
                       .translation_weights = StepWeights::distance}),
      method<Dual>("dual", "maximum likelihood on a chain, solved for the loop multipliers"),
      method<PoseGraphOptimizer>("pose_graph",
                                 "maximum likelihood by sparse least squares",
                                 {.start = PoseGraphOptimizer::Start::chordal}),
      method<PoseGraphOptimizer>("pose_graph_huber",
                                 "pose_graph with a Huber loss on closures",
                                 {.loss = RobustLoss::huber}),
      method<PoseGraphOptimizer>("pose_graph_cauchy",
                                 "pose_graph with a Cauchy loss on closures",
                                 {.loss = RobustLoss::cauchy}),
      method<PoseGraphOptimizer>("pose_graph_dcs",
                                 "pose_graph with dynamic covariance scaling",
                                 {.loss = RobustLoss::dcs}),
      method<PoseGraphOptimizer>("pose_graph_gnc_tls",
                                 "pose_graph, graduated non-convexity with truncated least squares",
                                 {.start = PoseGraphOptimizer::Start::chordal, .gnc = Gnc::tls}),
      method<PairwiseConsistent<Dual>>("dual_pcm",
                                       "dual on the largest pairwise consistent set of closures"),
      method<PairwiseConsistent<PoseGraphOptimizer>>(
          "pose_graph_pcm",
          "pose_graph on the largest pairwise consistent set of closures",
          {.base = {.start = PoseGraphOptimizer::Start::chordal}}),
      method<Consensus>("consensus",
                        "pose_graph on the closures that agree, with calibrated covariances"),

      // Smoothers: keyframes in, a curve out.
      smoother("polyline", "linear interpolation of position, slerp of rotation", polyline),
      method<TrackedFrames>("tracked_frames",
                            "tracked frames, moved with the corrected keyframes around them"),
      method<CubicSpline>("cubic_spline", "natural cubic spline in time through the keyframes"),
      method<BSplineThrough>("b_spline", "B-spline of order k in time through the keyframes"),
      method<SmoothingSpline>("smoothing_spline",
                              "penalised cubic spline, penalty chosen by REML or GCV"),
      method<GaussianProcess>("gp_wnoa", "Gaussian process on SE(3), white noise on acceleration"),
      method<Dm>("dm",
                 "the article's manifold smoother with guards; window sizes by planar and spatial"),
      method<Dm>("dm_n3", "dm: parabola through 3 nodes", {.planar = 3}),
      method<Dm>("dm_n4", "dm: cubic through 4 nodes", {.planar = 4}),
      method<Dm>("dm_n5", "dm: least-squares cubic on 5 nodes", {.planar = 5}),
      method<Dm>("dm_m6", "dm: heights only, quadric through 6 nodes", {.planar = 0, .spatial = 6}),
      method<Dm>("dm_m7", "dm: heights only, quadric on 7 nodes", {.planar = 0, .spatial = 7}),
      method<Dm>("dm_m8", "dm: heights only, quadric on 8 nodes", {.planar = 0, .spatial = 8}),
      method<Dm>("dm_robust",
                 "dm with options chosen on training sequences, configs/dm_training.yaml",
                 robust()),

      // In front of a method.
      method<Online>("online", "replay: the method gets its data in the order of time"),
  };
}

MethodEntry find_method(const std::string& name) {
  const std::vector<MethodEntry> all = methods();
  const auto found = std::ranges::find(all, name, &MethodEntry::name);
  if (found != all.end()) return *found;
  std::string known;
  for (const MethodEntry& entry : all) known += (known.empty() ? "" : ", ") + entry.name;
  throw InputError("no method is named '" + name + "', expected one of " + known);
}

Trajectory correct(const Problem& problem, const std::string& name, const Params& options) {
  const MethodEntry entry = find_method(name);
  const Stage stage = entry.make(options);
  const auto* corrector = std::get_if<std::unique_ptr<const Corrector>>(&stage);
  if (corrector == nullptr) {
    throw InputError(name + ": is a " + to_text(entry.kind) + ", expected a corrector");
  }
  const std::string why = reason_to_decline(**corrector, problem);
  if (!why.empty()) throw InputError(name + ": is not applicable: " + why);
  Report report;
  return (*corrector)->correct(problem, report);
}

}  // namespace loopbench::methods
