/// What the figures of an evaluation need.
#pragma once

#include "harness/report/curve.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// One estimate, paired and aligned.
struct DrawnEvaluation {
  /// Without a name. Times count from the first pose of the reference file [s], distances along the
  /// complete reference [m], so that the curves of all estimates of a reference have one origin.
  /// Columns of the errors: error [m], angle [deg], and sorted_errors [m] of all poses.
  DrawnCurve estimate;
  DrawnCurve reference;        ///< the complete reference, subsampled
  double position_rmse = 0.0;  ///< [m]
};

/// `reference`: the complete one, ascending stamps. O(n log n + m).
DrawnEvaluation drawn_evaluation(const Trajectory& reference,
                                 const metrics::Evaluation& evaluation);

}  // namespace loopbench::harness
