#include <cmath>
#include <stdexcept>

#include "metrics/checks/body_offset.hpp"
#include "metrics/checks/coverage.hpp"
#include "metrics/checks/diagnostics.hpp"
#include "metrics/correction/closure_residual.hpp"
#include "metrics/correction/gain_along.hpp"
#include "metrics/correction/graph_cost.hpp"
#include "metrics/correction/interpolation_floor.hpp"
#include "metrics/correction/jerk.hpp"
#include "metrics/correction/jumps.hpp"
#include "metrics/correction/local_shape.hpp"
#include "metrics/correction/loop_detection.hpp"
#include "metrics/correction/path_length.hpp"
#include "metrics/correction/smoothing_headroom.hpp"
#include "metrics/errors/along_cross.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/axis_error.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/errors/segments.hpp"
#include "metrics/metric.hpp"

namespace loopbench {

Score single(std::string relation, std::string axis, std::string unit, double value) {
  if (!std::isfinite(value)) throw std::runtime_error(relation + " is not finite");
  return {std::move(relation),
          std::move(axis),
          std::move(unit),
          {1, value, value, value, 0.0, value, value, value * value}};
}

std::vector<MetricEntry> metrics() {
  return {
      metric<AteOptions>("ate", "distance and angle of each pose from its reference", ate),
      metric<AxisErrorOptions>("axis_error", "position error along x, y and z", axis_error),
      metric<ApeOptions>("ape", "absolute error in one of evo's pose relations", ape),
      metric<RpeOptions>("rpe", "error of the motion over frames, seconds, metres or turns", rpe),
      metric<SegmentsOptions>("segments", "drift over sub-trajectories of given lengths", segments),
      metric<AlongCrossOptions>(
          "along_cross", "position error along, across and above the way travelled", along_cross),
      metric<GainAlongOptions>(
          "gain_along", "what was gained on the raw keyframes, by axis and third", gain_along),
      metric<ClosureResidualOptions>(
          "closure_residual", "what the loop closures still disagree with", closure_residual),
      metric_without_reference<GraphCostOptions>(
          "graph_cost", "squared Mahalanobis errors of all edges, summed", graph_cost),
      metric<LocalShapeOptions>(
          "local_shape", "how far neighbouring keyframes moved against each other", local_shape),
      metric<JumpsOptions>("jumps", "jumps of the curve and its derivatives at keyframes", jumps),
      metric<PathLengthOptions>(
          "path_length", "length of the way over the reference's", path_length_ratio),
      metric<JerkOptions>("jerk", "third derivative of the curve beside the reference's", jerk),
      metric<InterpolationFloorOptions>("interpolation_floor",
                                        "error that remains if every keyframe were exact",
                                        interpolation_floor),
      metric<SmoothingHeadroomOptions>("smoothing_headroom",
                                       "what taking all fast error away would gain at most",
                                       smoothing_headroom),
      metric<CoverageOptions>("coverage", "how much of the trajectory was judged", coverage),
      metric_without_reference<DetectionRule>(
          "loop_detection",
          "the place recogniser: precision, recall and their curve",
          loop_detection),
      metric<BodyOffsetOptions>(
          "body_offset", "where the reference's body sits in the estimate's", body_offset_scores),
      metric<DiagnosticsOptions>("diagnostics", "can the numbers be trusted at all", diagnostics),
  };
}

}  // namespace loopbench
