#include "methods/correctors/checked.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/elch.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/correctors/raw.hpp"
#include "methods/correctors/two_pass.hpp"
#include "methods/correctors/uniform.hpp"
#include "methods/joint/spline_fit.hpp"
#include "methods/method.hpp"
#include "methods/smoothers/b_spline.hpp"
#include "methods/smoothers/cubic_spline.hpp"
#include "methods/smoothers/gaussian_process.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "methods/smoothers/polyline.hpp"
#include "methods/smoothers/savitzky_golay.hpp"
#include "methods/smoothers/screw.hpp"
#include "methods/smoothers/smoothing_spline.hpp"
#include "methods/smoothers/spline_regression.hpp"
#include "methods/smoothers/tracked_frames.hpp"
#include "methods/smoothers/trend_filter.hpp"

namespace loopbench {
namespace {

/// y = f(x) and z = q(x, y) in the axes of the world, wherever the nodes lead; pieces as they come.
Dm::Options paper_literal(const manifold::SegmentRule& thresholds) {
  return {.planar = 4,
          .spatial = 7,
          .segment = thresholds,
          .chord_above = std::nullopt,
          .up = manifold::Up::world_z,
          .height_guard = false,
          .frame = manifold::Axes::world,
          .guard = false,
          .quadric_cut = 1e-12,  // rounding only: a design of full rank is solved as it is
          .joint = {.meet = manifold::Meet::none}};
}

/// What came out best on sequences that are not the article's: results/paper/training.md. Curves
/// where the speed is steady for a while, straight lines elsewhere. Turning ends no segment (no
/// turn exceeds pi), and where nodes are no graph the spline stands.
Dm::Options robust() {
  return {.planar = 5,
          .segment = {.speed_band = 0.1, .turn_max = 10.0},
          .gap = {.time_max = 0.3},
          .fallback = manifold::Fallback::spline,
          .scheme = manifold::Scheme::sliding_blend,
          .short_policy = manifold::Short::polyline,
          .min_nodes = 9};
}

}  // namespace

std::vector<MethodEntry> methods() {
  return {
      // Correctors: keyframes in, keyframes out.
      method<Raw>("raw", "keyframes as the tracker left them"),
      method<Uniform>("uniform", "closing error spread evenly along each loop"),
      method<Uniform>("uniform_position",
                      "closing error spread evenly, positions only",
                      {.rotation = Uniform::Turn::none}),
      method<Uniform>("uniform_open",
                      "closing error spread evenly over what no earlier loop has closed",
                      {.overlap = LoopOverlap::open}),
      method<Elch>("elch", "closing error spread by distance in the pose graph"),
      method<TwoPass>("two_pass", "rotation spread and re-integrated, then translation"),
      method<TwoPass>("two_pass_open",
                      "two_pass over what no earlier loop has closed",
                      {.overlap = LoopOverlap::open}),
      method<TwoPass>("two_pass_motion",
                      "two_pass, rotation by angle turned and translation by distance",
                      {.rotation_weights = StepWeights::rotation,
                       .translation_weights = StepWeights::distance}),
      method<Dual>("dual", "maximum likelihood on the chain, through the loop multipliers"),
      method<MotionDrift>("motion_drift_const",
                          "dual, variances fitted to the loops: the same in every edge",
                          {.model = MotionDrift::Model::constant}),
      method<MotionDrift>("motion_drift_time",
                          "dual, fitted variances that grow with time",
                          {.model = MotionDrift::Model::time}),
      method<MotionDrift>("motion_drift_distance",
                          "dual, fitted variances that grow with time and distance",
                          {.model = MotionDrift::Model::distance}),
      method<MotionDrift>("motion_drift_rotation",
                          "dual, fitted variances that grow with time, distance and turning",
                          {.model = MotionDrift::Model::rotation}),
      method<MotionDrift>("motion_drift_speed",
                          "motion_drift_rotation, and with speed",
                          {.model = MotionDrift::Model::speed}),
      method<MotionDrift>("motion_drift",
                          "motion_drift_rotation with steady drift, averaged over models that the "
                          "loops allow"),
      method<PoseGraphOptimizer>("pose_graph",
                                 "maximum likelihood by sparse least squares (Ceres)",
                                 {.start = PoseGraphOptimizer::Start::chordal}),
      method<PoseGraphOptimizer>(
          "pose_graph_huber", "pose_graph, closures under a Huber loss", {.loss = Loss::huber}),
      method<PoseGraphOptimizer>(
          "pose_graph_cauchy", "pose_graph, closures under a Cauchy loss", {.loss = Loss::cauchy}),
      method<PoseGraphOptimizer>("pose_graph_switchable",
                                 "pose_graph with switchable constraints, switches solved for",
                                 {.loss = Loss::switchable}),
      method<PoseGraphOptimizer>(
          "pose_graph_dcs", "pose_graph with dynamic covariance scaling", {.loss = Loss::dcs}),
      method<PoseGraphOptimizer>("pose_graph_gnc_tls",
                                 "pose_graph, graduated to truncated least squares",
                                 {.start = PoseGraphOptimizer::Start::chordal, .gnc = Gnc::tls}),
      method<PoseGraphOptimizer>("pose_graph_gnc_gm",
                                 "pose_graph, graduated to Geman-McClure",
                                 {.start = PoseGraphOptimizer::Start::chordal, .gnc = Gnc::gm}),
      method<Checked<TwoPass>>("two_pass_pcm",
                               "two_pass on the largest set of closures that agree"),
      method<Checked<Dual>>("dual_pcm", "dual on the largest set of closures that agree"),
      method<Checked<MotionDrift>>("motion_drift_pcm",
                                   "motion_drift on the largest set of closures that agree"),
      method<Checked<PoseGraphOptimizer>>("pose_graph_pcm",
                                          "pose_graph on the largest set of closures that agree",
                                          {.base = {.start = PoseGraphOptimizer::Start::chordal}}),

      // Smoothers: keyframes in, a curve out.
      method<PolylineSmoother>("polyline", "straight lines and great arcs between keyframes"),
      method<TrackedFrames>("tracked_frames",
                            "the tracked frames, attached to the keyframes around them"),
      method<CubicSpline>("cubic_spline", "natural cubic spline in time through the keyframes"),
      method<BSplineThrough>("b_spline", "B-spline of order k in time through the keyframes"),
      method<Screw>("screw", "one screw motion from keyframe to keyframe"),
      method<SavitzkyGolay>("savitzky_golay", "local polynomials in time"),
      method<SmoothingSpline>("smoothing_spline",
                              "penalised cubic spline, stiffness by REML or GCV"),
      method<TrendFilter>("trend_filter", "piecewise straight motion by L1 trend filtering"),
      method<GaussianProcess>("gp_wnoa", "Gaussian process on SE(3), white noise on acceleration"),
      method<GaussianProcess>("gp_wnoj",
                              "Gaussian process on SE(3), white noise on jerk",
                              {.prior = GaussianProcess::Prior::acceleration}),
      method<SplineRegression>("spline_regression",
                               "cumulative B-spline with fewer knots than keyframes"),
      method<Dm>("dm", "the paper's manifold smoother, read robustly; N = 4"),
      method<Dm>("dm_n3", "dm: parabola through 3 nodes", {.planar = 3}),
      method<Dm>("dm_n4", "dm: cubic through 4 nodes", {.planar = 4}),
      method<Dm>("dm_n5", "dm: least-squares cubic on 5 nodes", {.planar = 5}),
      method<Dm>("dm_m6", "dm: only heights, quadric through 6 nodes", {.planar = 0, .spatial = 6}),
      method<Dm>("dm_m7", "dm: only heights, quadric on 7 nodes", {.planar = 0, .spatial = 7}),
      method<Dm>("dm_m8", "dm: only heights, quadric on 8 nodes", {.planar = 0, .spatial = 8}),
      method<Dm>("dm_n3_m6", "dm: N = 3 in the plane, M = 6 in space", {.planar = 3, .spatial = 6}),
      method<Dm>("dm_n3_m7", "dm: N = 3 in the plane, M = 7 in space", {.planar = 3, .spatial = 7}),
      method<Dm>("dm_n3_m8", "dm: N = 3 in the plane, M = 8 in space", {.planar = 3, .spatial = 8}),
      method<Dm>("dm_n4_m6", "dm: N = 4 in the plane, M = 6 in space", {.planar = 4, .spatial = 6}),
      method<Dm>("dm_n4_m7", "dm: N = 4 in the plane, M = 7 in space", {.planar = 4, .spatial = 7}),
      method<Dm>("dm_n4_m8", "dm: N = 4 in the plane, M = 8 in space", {.planar = 4, .spatial = 8}),
      method<Dm>("dm_n5_m6", "dm: N = 5 in the plane, M = 6 in space", {.planar = 5, .spatial = 6}),
      method<Dm>("dm_n5_m7", "dm: N = 5 in the plane, M = 7 in space", {.planar = 5, .spatial = 7}),
      method<Dm>("dm_n5_m8", "dm: N = 5 in the plane, M = 8 in space", {.planar = 5, .spatial = 8}),
      method<Dm>(
          "dm_robust", "dm as chosen on training sequences, configs/dm_training.yaml", robust()),
      method<Dm>("paper_literal_fr1",
                 "the article's letter with its thresholds for fr1_room: world axes, no guard",
                 paper_literal({.speed_band = 0.33, .turn_max = 0.75})),
      method<Dm>("paper_literal_fr3",
                 "the article's letter with its thresholds for fr3_office: world axes, no guard",
                 paper_literal({.speed_band = 0.25, .turn_max = 0.42})),

      // Both at once.
      method<SplineFit>("spline_fit",
                        "cumulative B-spline fitted to odometry and closures (Ceres)"),
  };
}

}  // namespace loopbench
