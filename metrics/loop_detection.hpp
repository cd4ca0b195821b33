/// A place recogniser judged as a detector: precision, recall, and the curve between them.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct LoopDetectionOptions {
  double radius = 1.0;
  double angle = 35.0;
  double min_gap = 5.0;
  double wrong_metres = 0.25;
  double wrong_degrees = 10.0;
};

template <class Visit>
void fields(LoopDetectionOptions& o, Visit visit) {
  visit("radius", o.radius, "farthest that two views of a place lie apart [m]", Above{0});
  visit("angle", o.angle, "most that they look apart [deg]", Between{0, 180});
  visit("min_gap", o.min_gap, "neighbours in time are no revisits [s]", Between{0});
  visit("wrong_metres", o.wrong_metres, "a closure off by more is false [m]", Above{0});
  visit("wrong_degrees", o.wrong_degrees, "a closure off by more is false [deg]", Above{0});
}

/// A keyframe is a revisit when an older one by min_gap lies within radius and angle of it in the
/// reference; a candidate is right when its pair does. Candidates are taken from the highest score
/// down. Single values in 0..1: `average_precision` (sum of precision times gain in recall, no
/// interpolation), `full_precision_recall` (recall before the first wrong candidate), `precision`
/// and `recall` of what was accepted, `precision_at` with axis `recall 0.1` .. `recall 1.0` (the
/// best precision at that recall or more: the curve; 0 where it is not reached); and counts:
/// `revisits`, `accepted`, and `false_closures`, closures whose measured pose is off the
/// reference's by more than wrong_metres or wrong_degrees. Keyframes outside the reference's time
/// are left out. Throws std::runtime_error without candidates or without revisits. O(keyframes^2).
std::vector<Score> loop_detection(const Evaluation& evaluation,
                                  const LoopDetectionOptions& options);

}  // namespace loopbench
