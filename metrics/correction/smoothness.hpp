/// Smoothness of the estimated curve: jerk, jumps at the keyframes, and path length.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "datasets/core/polyline.hpp"
#include "datasets/core/so3.hpp"
#include "metrics/metric.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {

struct JerkOptions {
  double rate = 10.0;
  double max_gap = 0.5;
};

template <class Visit>
void fields(JerkOptions& o, Visit visit) {
  visit("rate", o.rate, "sampling rate of both curves [1/s]", GreaterThan{0.0});
  visit(
      "max_gap", o.max_gap, "reference gap beyond which samples are skipped [s]", GreaterThan{0.0});
}

struct JumpsOptions {
  double reach = 0.1;
};

template <class Visit>
void fields(JumpsOptions& o, Visit visit) {
  visit("reach",
        o.reach,
        "fraction of the keyframe interval sampled on each side of a keyframe [-]",
        Between{1e-4, 0.5});
}

/// Newton's coefficients of the cubic with p(offsets[k]) = points[k]; c[3] is a sixth of its third
/// derivative. Offsets [s] must differ. Use the offsets of the rounded stamps: stamps near 1e9 s
/// have a resolution of 2.4e-7 s, and differences of neighbouring stamps are exact.
inline std::array<Vector3, 4> divided_differences(const std::array<double, 4>& offsets,
                                                  std::array<Vector3, 4> points) {
  for (std::size_t order = 1; order < 4; ++order) {
    for (std::size_t k = 3; k >= order; --k) {
      points[k] = (points[k] - points[k - 1]) / (offsets[k] - offsets[k - order]);
    }
  }
  return points;
}

inline constexpr double kMostSamples = 1e8;  // 6 GB

/// Times inside both spans with the given rate, in the curve's time.
inline std::vector<double> grid(const Curve& curve,
                                const Trajectory& reference,
                                double offset,
                                double rate) {
  const double begin = std::max(curve.start(), reference.front().stamp - offset);
  const double end = std::min(curve.end(), reference.back().stamp - offset);
  if (!((end - begin) * rate < kMostSamples)) {
    throw std::runtime_error("rate = " + to_text(rate) + " needs more than 1e8 samples");
  }
  std::vector<double> out;
  for (double k = 0.0; begin + k / rate <= end; ++k) out.push_back(begin + k / rate);
  return out;
}

/// Jerk [m/s^3] from four consecutive samples.
inline double jerk_of(const StampedPose* samples) {
  std::array<double, 4> offsets;
  std::array<Vector3, 4> points;
  for (std::size_t k = 0; k < 4; ++k) {
    offsets[k] = samples[k].stamp - samples[0].stamp;
    points[k] = samples[k].world_from_body.translation - samples[0].world_from_body.translation;
  }
  return 6.0 * divided_differences(offsets, points)[3].norm();
}

/// Samples curve and reference (linear between its poses) at the same times with `rate`. Jerk is 6
/// times the third divided difference: estimate and reference 3d [m/s^3], and the ratio of their
/// rmse [1]. Values for different rates are not comparable: noise of size s gives about 4.5 s
/// rate^3, and nothing is filtered before sampling. Intervals across a reference gap are skipped.
/// The estimate is scaled by the alignment. Throws Undefined without a curve, or with fewer than
/// four common samples. O(n + span * rate).
inline std::vector<Score> jerk(const Evaluation& evaluation, const JerkOptions& options) {
  const Context& context = evaluation.context;
  const Curve& curve = needed(context.curve, "a curve");
  const Trajectory& reference = needed(context.reference, "the complete reference");
  const double offset = context.protocol.offset;
  const std::vector<double> times = grid(curve, reference, offset, options.rate);
  std::vector<double> reference_times;
  for (const double time : times) {
    reference_times.push_back(
        std::clamp(time + offset, reference.front().stamp, reference.back().stamp));
  }
  const Trajectory ours = curve.sample(times);
  const Trajectory reference_samples = Polyline(reference).sample(reference_times);

  std::vector<double> estimate_jerk;
  std::vector<double> reference_jerk;
  double gap_until = -std::numeric_limits<double>::infinity();  // end of the last gap so far
  std::size_t next_pose = 0;
  for (std::size_t i = 0; i + 3 < times.size(); ++i) {
    // Only the last gap that begins before the end of the interval can overlap it.
    while (next_pose + 1 < reference.size() &&
           reference[next_pose].stamp < reference_samples[i + 3].stamp) {
      const double gap = reference[next_pose + 1].stamp - reference[next_pose].stamp;
      if (gap > options.max_gap + kStampRounding) gap_until = reference[next_pose + 1].stamp;
      ++next_pose;
    }
    if (gap_until > reference_samples[i].stamp) continue;
    estimate_jerk.push_back(evaluation.alignment.scale * jerk_of(&ours[i]));
    reference_jerk.push_back(jerk_of(&reference_samples[i]));
  }
  if (estimate_jerk.empty()) {
    throw Undefined("curve and reference have no four consecutive samples in common at " +
                    to_text(options.rate) + " Hz outside gaps");
  }
  const int ddof = evaluation.protocol.ddof;
  Score estimate{"estimate", "3d", "m/s^3", statistics(std::move(estimate_jerk), ddof)};
  Score truth{"reference", "3d", "m/s^3", statistics(std::move(reference_jerk), ddof)};
  Score ratio{"ratio", "3d", "1", {}, "the reference has zero jerk"};
  if (truth.statistics.rmse > 0.0) {
    ratio = single("ratio", "3d", "1", estimate.statistics.rmse / truth.statistics.rmse);
  }
  return {directed(std::move(estimate), Better::neither),
          directed(std::move(truth), Better::neither),
          directed(std::move(ratio), Better::target, 1.0)};
}

struct Motion {
  Vector3 position = Vector3::Zero();      ///< [m]
  Vector3 velocity = Vector3::Zero();      ///< [m/s]
  Vector3 acceleration = Vector3::Zero();  ///< [m/s^2]
};

/// One-sided limit at `stamp` from four samples, relative to `origin` to keep precision.
inline Motion limit(double stamp, const Vector3& origin, const StampedPose* samples) {
  std::array<double, 4> offsets;
  std::array<Vector3, 4> points;
  for (std::size_t k = 0; k < 4; ++k) {
    offsets[k] = samples[k].stamp - stamp;
    points[k] = samples[k].world_from_body.translation - origin;
    if (offsets[k] == 0.0 || (k > 0 && offsets[k] == offsets[k - 1])) {
      throw std::runtime_error("the stamps around " + to_text(stamp) +
                               " s are too coarse for four samples next to a keyframe");
    }
  }
  const std::array<Vector3, 4> c = divided_differences(offsets, points);
  Motion out{c[3]};
  for (std::size_t k = 3; k-- > 0;) {  // Horner, with both derivatives, at offset 0
    out.acceleration = -offsets[k] * out.acceleration + 2.0 * out.velocity;
    out.velocity = -offsets[k] * out.velocity + out.position;
    out.position = -offsets[k] * out.position + c[k];
  }
  return out;
}

/// Four times before and four after each interior keyframe, sorted.
inline std::vector<double> times_beside(const Trajectory& keyframes, double reach) {
  std::vector<double> out;
  out.reserve(8 * (keyframes.size() - 2));
  for (std::size_t i = 1; i + 1 < keyframes.size(); ++i) {
    const double here = keyframes[i].stamp;
    const double before = 0.25 * reach * (here - keyframes[i - 1].stamp);
    const double after = 0.25 * reach * (keyframes[i + 1].stamp - here);
    for (int k = 4; k >= 1; --k) out.push_back(here - k * before);
    for (int k = 1; k <= 4; ++k) out.push_back(here + k * after);
  }
  return out;
}

/// At every interior keyframe, right limit minus left limit of the curve, scaled by the alignment:
/// position [m], velocity [m/s], acceleration [m/s^2]. A polyline has velocity jumps, a cubic
/// spline has none.
///
/// Each limit is extrapolated from the cubic through four points at 1/4, 2/4, 3/4 and 4/4 of
/// `reach` times the interval on its side: exact for pieces up to cubic, otherwise with error
/// O(h^4), O(h^3), O(h^2), where h = reach * interval. Rounding of positions of size p adds about
/// p 1e-16 {15, 130/h, 640/h^2}: for p = 10 m, h = 0.05 s that is 1e-14, 3e-12, 3e-10. Knots
/// between keyframes are not evaluated, because a curve does not expose its knots. Throws Undefined
/// without a curve or for fewer than three keyframes, std::runtime_error if the stamps are too
/// coarse for four different times. O(keyframes).
inline std::vector<Score> jumps(const Evaluation& evaluation, const JumpsOptions& options) {
  const Curve& curve = needed(evaluation.context.curve, "a curve");
  const Trajectory& keyframes = needed(evaluation.context.estimate, "keyframes");
  if (keyframes.size() < 3) throw Undefined("needs at least three keyframes");
  // One call, because evaluating a curve can have an O(n) setup cost.
  const Trajectory samples = curve.sample(times_beside(keyframes, options.reach));
  const double scale = evaluation.alignment.scale;
  std::vector<double> position;
  std::vector<double> velocity;
  std::vector<double> acceleration;
  for (std::size_t i = 1; i + 1 < keyframes.size(); ++i) {
    const auto& [stamp, pose] = keyframes[i];
    const StampedPose* beside = &samples[8 * (i - 1)];
    const Motion left = limit(stamp, pose.translation, beside);
    const Motion right = limit(stamp, pose.translation, beside + 4);
    position.push_back(scale * (right.position - left.position).norm());
    velocity.push_back(scale * (right.velocity - left.velocity).norm());
    acceleration.push_back(scale * (right.acceleration - left.acceleration).norm());
  }
  const int ddof = evaluation.protocol.ddof;
  return {{"position", "3d", "m", statistics(std::move(position), ddof)},
          {"velocity", "3d", "m/s", statistics(std::move(velocity), ddof)},
          {"acceleration", "3d", "m/s^2", statistics(std::move(acceleration), ddof)}};
}

/// Sum of the distances between evaluated poses, after alignment: estimate [m], reference [m],
/// ratio [1] = estimate over reference. Both are sampled at the same pairs, so a denser list has no
/// effect; jitter still increases the length. sim3 alignment removes most of the deviation from 1.
/// Throws Undefined if the reference does not move. O(n).
inline std::vector<Score> path_length_ratio(const Evaluation& evaluation) {
  const double estimate = path_length(evaluation.estimate);
  const double reference = path_length(evaluation.reference);
  if (reference == 0.0) throw Undefined("the reference does not move");
  return {directed(single("ratio", "", "1", estimate / reference), Better::target, 1.0),
          directed(single("estimate", "", "m", estimate), Better::neither),
          directed(single("reference", "", "m", reference), Better::neither)};
}

}  // namespace loopbench::metrics
