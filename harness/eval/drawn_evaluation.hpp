/// What the figures of an evaluation need.
#pragma once

#include <string>
#include <vector>

#include "harness/plot/style.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// One estimate, paired and aligned.
struct DrawnEvaluation {
  std::string name;
  Trajectory reference;  ///< paired with `estimate`
  Trajectory estimate;   ///< aligned
  /// Of each pair: time since the first pose of the reference file [s] and distance along the
  /// complete reference [m], so that the curves of all estimates of a reference have one origin.
  std::vector<double> times, distances;
  Trajectory complete;  ///< the complete reference, subsampled, stamps as `times`
  CurveStyle style = curve_style(0);
};

/// Without a name. `reference`: the complete one, ascending stamps. O((n + m) log n).
DrawnEvaluation drawn_evaluation(const Trajectory& reference,
                                 const metrics::Evaluation& evaluation);

/// Root mean square of the position errors [m].
double position_rmse(const DrawnEvaluation& drawn);

}  // namespace loopbench::harness
