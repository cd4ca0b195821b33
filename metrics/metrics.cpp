#include <cmath>
#include <stdexcept>

#include "metrics/checks/diagnostics.hpp"
#include "metrics/checks/extrinsic_offset.hpp"
#include "metrics/correction/closure_choice.hpp"
#include "metrics/correction/closure_prediction.hpp"
#include "metrics/correction/graph_cost.hpp"
#include "metrics/correction/interpolation_floor.hpp"
#include "metrics/correction/loop_detection.hpp"
#include "metrics/correction/optimality.hpp"
#include "metrics/correction/smoothness.hpp"
#include "metrics/errors/accuracy.hpp"
#include "metrics/errors/along_cross.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/axis_error.hpp"
#include "metrics/errors/drift.hpp"
#include "metrics/errors/nees.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/errors/segments.hpp"
#include "metrics/metric.hpp"
#include "metrics/online/replayed.hpp"

namespace loopbench::metrics {

Score single(std::string relation, std::string axis, std::string unit, double value) {
  if (!std::isfinite(value)) throw std::runtime_error(relation + " is not finite");
  return {std::move(relation),
          std::move(axis),
          std::move(unit),
          {1, value, value, value, 0.0, value, value, value * value, value, value, value}};
}

std::vector<MetricEntry> metrics() {
  return {
      metric<NoOptions>(
          "ate", "absolute trajectory error: distance and rotation angle of each pose", ate),
      metric<AxisErrorOptions>("axis_error", "position error along x, y and z", axis_error),
      metric<ApeOptions>("ape", "absolute error in one of evo's pose relations", ape),
      metric<RpeOptions>(
          "rpe", "relative pose error over frames, seconds, metres or rotation angles", rpe),
      metric("drift", "position error in per cent of the reference's path", drift),
      metric("end_error", "error of the motion from the first to the last pose", end_error),
      metric<SnippetAteOptions>(
          "snippet_ate", "error of snippets of five frames with a scale of their own", snippet_ate),
      metric<SegmentsOptions>("segments", "drift over sub-trajectories of given lengths", segments),
      metric<AlongCrossOptions>("along_cross",
                                "position error along, across and above the direction of travel",
                                along_cross),
      metric<AccuracyOptions>(
          "accuracy",
          "shares of the reference's time with a position error below thresholds",
          accuracy),
      metric<ControlPointsOptions>("control_points",
                                   "score of the Hilti SLAM Challenge for surveyed points",
                                   control_points),
      metric<NeesOptions>(
          "nees", "errors over their stated covariances: NEES, and coverage of regions", nees),
      metric("closure_residual",
             "residuals of the loop closures after the correction",
             closure_residual),
      metric_without_reference<ClosurePredictionOptions>(
          "closure_prediction",
          "error of closures predicted by those of other places, over that of the odometry",
          closure_prediction),
      metric_without_reference<NoOptions>("closures_kept_false",
                                          "share of the false closures that the method kept",
                                          closures_kept_false),
      metric_without_reference<NoOptions>("closures_dropped_true",
                                          "share of the true closures that the method rejected",
                                          closures_dropped_true),
      metric_without_reference<GraphCostOptions>(
          "graph_cost", "sum of squared Mahalanobis errors over all edges", graph_cost),
      metric_without_reference<NoOptions>(
          "optimality",
          "proved bound on the distance of a pose graph from its optimum",
          optimality),
      metric<JumpsOptions>(
          "jumps", "discontinuities of the curve and its derivatives at keyframes", jumps),
      metric(
          "path_length", "ratio of the path lengths of estimate and reference", path_length_ratio),
      metric<JerkOptions>(
          "jerk", "jerk (third derivative) of the curve and of the reference", jerk),
      metric<InterpolationFloorOptions>("interpolation_floor",
                                        "interpolation error between keyframes if they were exact",
                                        interpolation_floor),
      metric("coverage", "share of the estimate and the reference that was evaluated", coverage),
      metric_without_reference<DetectionRule>(
          "loop_detection",
          "place recognition: precision, recall and precision-recall curve",
          loop_detection),
      metric<ExtrinsicOffsetOptions>(
          "extrinsic_offset",
          "extrinsic offset of the reference's body by hand-eye calibration",
          extrinsic_offset_scores),
      metric("causal_ate", "ate of each pose at its own time, in a replay", causal_ate),
      metric<RpeOptions>("causal_rpe", "rpe of each pose at its own time, in a replay", causal_rpe),
      metric_without_reference<NoOptions>(
          "closure_jumps", "jump of the current pose at each closure, in a replay", closure_jumps),
      metric_without_reference<UpdateTimeOptions>(
          "update_time",
          "time of an update, its growth, and deadline misses, in a replay",
          update_time),
      metric<DiagnosticsOptions>(
          "diagnostics", "data checks: pairs, tracking gaps, alignment, time at rest", diagnostics),
  };
}

}  // namespace loopbench::metrics
