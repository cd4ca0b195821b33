/// Evaluation of one method on one sequence, as the harness passes it to a metric.
#pragma once

#include <memory>

#include "datasets/core/polyline.hpp"
#include "metrics/evaluation/evaluation.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::test {

using namespace metrics;

/// Owns everything its evaluation points to; do not copy or move.
struct EvaluatedCell {
  EvaluatedCell(Trajectory truth,
                Problem given,
                std::unique_ptr<const Curve> estimate,
                Times times,
                const Protocol& protocol = {})
      : reference(std::move(truth)),
        problem(std::move(given)),
        curve(std::move(estimate)),
        at_keyframes(curve->sample(stamps(problem.keyframes))),
        evaluation(evaluate(reference,
                            *curve,
                            stamps(problem.keyframes),
                            times,
                            protocol,
                            tracked_stamps(problem))) {
    evaluation.context = {.reference = &reference,
                          .estimate = &at_keyframes,
                          .problem = &problem,
                          .curve = curve.get(),
                          .times = times,
                          .protocol = protocol};
  }
  /// The polyline through poses at the keyframes.
  EvaluatedCell(Trajectory truth, Problem given, Trajectory poses, const Protocol& protocol = {})
      : EvaluatedCell(std::move(truth),
                      std::move(given),
                      std::make_unique<Polyline>(std::move(poses)),
                      Times::keyframes,
                      protocol) {}
  EvaluatedCell(const EvaluatedCell&) = delete;

  Trajectory reference;
  Problem problem;
  std::unique_ptr<const Curve> curve;
  Trajectory at_keyframes;
  Evaluation evaluation;
};

}  // namespace loopbench::test
