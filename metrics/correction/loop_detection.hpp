/// Evaluation of place recognition as a detector: precision, recall, precision-recall curve.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "datasets/core/sequence.hpp"
#include "metrics/metric.hpp"

namespace loopbench::metrics {

using loopbench::to_text;  // in addition to the overload below

/// Criteria for a revisited place and for a false closure.
struct DetectionRule {
  double radius = 1.0;          ///< largest distance between two views of one place [m]
  double angle = 35.0;          ///< largest rotation angle between two views of one place [deg]
  double min_gap = 5.0;         ///< smallest time between a view and a revisit [s]
  double wrong_metres = 0.25;   ///< translation error above which a closure is false [m]
  double wrong_degrees = 10.0;  ///< rotation error above which a closure is false [deg]
};

template <class Visit>
void fields(DetectionRule& o, Visit visit) {
  visit("radius", o.radius, "largest distance between two views of one place [m]", GreaterThan{0});
  visit("angle",
        o.angle,
        "largest rotation angle between two views of one place [deg]",
        Between{0, 180});
  visit("min_gap", o.min_gap, "smallest time between a view and a revisit [s]", Between{0});
  visit("wrong_metres",
        o.wrong_metres,
        "translation error above which a closure is false [m]",
        GreaterThan{0});
  visit("wrong_degrees",
        o.wrong_degrees,
        "rotation error above which a closure is false [deg]",
        GreaterThan{0});
}

struct Detection {
  std::size_t revisits = 0;    ///< keyframes that revisit a place
  std::size_t accepted = 0;    ///< candidates that became closures
  std::size_t wrong_pose = 0;  ///< closures with a false relative pose
  double precision = 1.0;      ///< of the accepted candidates; 1 if none was accepted
  double recall = 0.0;         ///< of the accepted candidates
  double average_precision = 0.0;
  double full_precision_recall = 0.0;        ///< recall before the first wrong candidate
  std::array<double, 10> precision_at = {};  ///< best precision at recall >= 0.1, 0.2, ..., 1.0
};

/// A keyframe is a revisit if a keyframe at least min_gap older lies within radius and angle of it
/// in the interpolated reference; a candidate is correct if its pair does. Candidates are taken in
/// descending order of score, equal scores together. Average precision is the sum of precision
/// times increase in recall, without interpolation. Keyframes outside the reference's time span are
/// skipped. Throws std::runtime_error without a reference. O(keyframes^2).
Detection evaluate_detection(const Problem& problem,
                             const Trajectory& reference,
                             const std::vector<LoopCandidate>& candidates,
                             const DetectionRule& rule);

/// One-line summary.
std::string to_text(const Detection& detection);

/// The same as scores: counts of revisits, closures and false_poses; precision, recall,
/// average_precision, full_precision_recall; and the curve, precision_at_recall with the recall
/// (0.1 .. 1.0) as axis. Identical for every method, because it evaluates the sequence. Undefined
/// without a reference, without candidates, or without revisits.
std::vector<Score> loop_detection(const Evaluation& evaluation, const DetectionRule& rule);

}  // namespace loopbench::metrics
