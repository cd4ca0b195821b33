/// Errors in per cent of the path, at the end of the path, and of short snippets.
#pragma once

#include <cmath>
#include <vector>

#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/pairing/motion.hpp"

namespace loopbench::metrics {

/// Length of the paired reference [m]. Throws Undefined if it does not move.
inline double evaluated_length(const Evaluation& evaluation) {
  const double length = path_length(evaluation.reference);
  if (!(length > 0.0)) throw Undefined("the reference does not move");
  return length;
}

/// translation 3d [%]: distance of each pose from its reference after alignment, as in ate(), over
/// the length of the reference's evaluated path. O(n).
inline std::vector<Score> drift(const Evaluation& evaluation) {
  const double length = evaluated_length(evaluation);
  std::vector<double> shares;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    const Vector3 error = evaluation.reference[i].world_from_body.translation -
                          evaluation.estimate[i].world_from_body.translation;
    shares.push_back(100.0 * error.norm() / length);
  }
  return {{"translation", "3d", "%", statistics(std::move(shares), evaluation.protocol.ddof)}};
}

/// Difference of the motions from the first to the last pair, which no alignment of the world
/// changes: translation [m] and [%] of the reference's path, and rotation [deg]. Undefined for
/// positions without rotation. O(n).
inline std::vector<Score> end_error(const Evaluation& evaluation) {
  if (const std::string why = why_no_attitude(evaluation); !why.empty()) throw Undefined(why);
  const auto motion = [](const Trajectory& poses) {
    return relative_pose(poses.front().world_from_body, poses.back().world_from_body);
  };
  const Pose error = relative_pose(motion(evaluation.reference), motion(evaluation.estimate));
  const double metres = error.translation.norm();
  const double share = 100.0 * metres / evaluated_length(evaluation);
  return {single("translation", "3d", "m", metres),
          single("share", "3d", "%", share),
          single("rotation", "3d", "deg", kDegrees * log_so3(error.rotation).norm())};
}

struct SnippetAteOptions {
  int frames = 5;
};

template <class Visit>
void fields(SnippetAteOptions& o, Visit visit) {
  visit("frames", o.frames, "number of consecutive pairs in a snippet", Between{2.0, 1e6});
}

/// translation 3d [m] of every snippet of consecutive pairs: positions in the frame of the first
/// pose of each file, the estimate's times the scale that fits them best; root of the sum of
/// squares, divided by the number of frames, as in SfMLearner and Monodepth2 (`mean` and `std` are
/// what they print). Undefined for positions without rotation. O(n frames).
inline std::vector<Score> snippet_ate(const Evaluation& evaluation,
                                      const SnippetAteOptions& options) {
  if (const std::string why = why_no_attitude(evaluation); !why.empty()) throw Undefined(why);
  const auto frames = static_cast<std::size_t>(options.frames);
  const std::size_t n = evaluation.reference.size();
  if (n < frames) throw Undefined("fewer pairs than a snippet has frames");
  std::vector<double> errors;
  for (std::size_t first = 0; first + frames <= n; ++first) {
    double common = 0.0, of_estimate = 0.0, of_reference = 0.0;
    for (std::size_t i = first; i < first + frames; ++i) {
      const auto position = [&](const Trajectory& poses) {
        return relative_pose(poses[first].world_from_body, poses[i].world_from_body).translation;
      };
      const Vector3 a = position(evaluation.reference), b = position(evaluation.estimate);
      common += a.dot(b);
      of_reference += a.squaredNorm();
      of_estimate += b.squaredNorm();
    }
    // |a - s b|^2 at s = a.b / b.b
    const double explained = of_estimate > 0.0 ? common * common / of_estimate : 0.0;
    errors.push_back(std::sqrt(std::max(0.0, of_reference - explained)) /
                     static_cast<double>(frames));
  }
  return {{"translation", "3d", "m", statistics(std::move(errors), evaluation.protocol.ddof)}};
}

}  // namespace loopbench::metrics
