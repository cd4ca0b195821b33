/// A place recogniser judged as a detector: precision, recall, and the curve between them.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "datasets/core/sequence.hpp"
#include "metrics/metric.hpp"

namespace loopbench {

/// What counts as the same place, and as a false closure.
struct DetectionRule {
  double radius = 1.0;          ///< farthest that two views of a place lie apart [m]
  double angle = 35.0;          ///< most that they look apart [deg]
  double min_gap = 5.0;         ///< neighbours in time are no revisits [s]
  double wrong_metres = 0.25;   ///< a closure off by more is false [m]
  double wrong_degrees = 10.0;  ///< a closure off by more is false [deg]
};

template <class Visit>
void fields(DetectionRule& o, Visit visit) {
  visit("radius", o.radius, "farthest that two views of a place lie apart [m]", Above{0});
  visit("angle", o.angle, "most that they look apart [deg]", Between{0, 180});
  visit("min_gap", o.min_gap, "neighbours in time are no revisits [s]", Between{0});
  visit("wrong_metres", o.wrong_metres, "a closure off by more is false [m]", Above{0});
  visit("wrong_degrees", o.wrong_degrees, "a closure off by more is false [deg]", Above{0});
}

struct Detection {
  std::size_t revisits = 0;    ///< keyframes that see a place again
  std::size_t accepted = 0;    ///< candidates that became closures
  std::size_t wrong_pose = 0;  ///< closures whose measured pose is false
  double precision = 1.0;      ///< of the accepted; 1 when none was
  double recall = 0.0;         ///< of the accepted
  double average_precision = 0.0;
  double full_precision_recall = 0.0;        ///< recall before the first wrong candidate
  std::array<double, 10> precision_at = {};  ///< best precision at recall 0.1 .. 1.0 or more
};

/// A keyframe is a revisit when an older one by min_gap lies within radius and angle of it in the
/// reference (read between its poses); a candidate is right when its pair does. Candidates are
/// taken from the highest score down, equal scores together; average precision is the sum of
/// precision times gain in recall, without interpolation. Keyframes outside the reference's time
/// are left out. Throws std::runtime_error without a reference. O(keyframes^2).
Detection judge_detection(const Problem& problem,
                          const Trajectory& reference,
                          const std::vector<LoopCandidate>& candidates,
                          const DetectionRule& rule);

inline Detection judge_detection(const Sequence& sequence, const DetectionRule& rule) {
  return judge_detection(sequence.problem, sequence.reference, sequence.loop_candidates, rule);
}

/// One line of it.
std::string to_text(const Detection& detection);

/// The same as rows: counts of revisits, closures and false_poses; precision, recall,
/// average_precision, full_precision_recall; and the curve, precision_at_recall with the recall
/// (0.1 .. 1.0) as axis. The same for every method: it is the sequence that is judged. Undefined
/// without a reference, candidates (nothing was looked for, or nothing looked alike) or revisits.
std::vector<Score> loop_detection(const Evaluation& evaluation, const DetectionRule& rule);

}  // namespace loopbench
