#include "metrics/correction/jerk.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "datasets/core/polyline.hpp"
#include "metrics/numerics/divided_differences.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kMostSamples = 1e8;  // 6 GB

/// Times inside both spans with the given rate, in the curve's time.
std::vector<double> grid(const Curve& curve,
                         const Trajectory& reference,
                         double offset,
                         double rate) {
  const double begin = std::max(curve.start(), reference.front().stamp - offset);
  const double end = std::min(curve.end(), reference.back().stamp - offset);
  if (!((end - begin) * rate < kMostSamples)) {
    throw std::runtime_error("jerk: rate = " + to_text(rate) + " needs more than 1e8 samples");
  }
  std::vector<double> out;
  for (double k = 0.0; begin + k / rate <= end; ++k) out.push_back(begin + k / rate);
  return out;
}

/// Jerk [m/s^3] from four consecutive samples.
double jerk_of(const StampedPose* samples) {
  std::array<double, 4> offsets;
  std::array<Vector3, 4> points;
  for (std::size_t k = 0; k < 4; ++k) {
    offsets[k] = samples[k].stamp - samples[0].stamp;
    points[k] = samples[k].world_from_body.translation - samples[0].world_from_body.translation;
  }
  return 6.0 * divided_differences(offsets, points)[3].norm();
}

}  // namespace

std::vector<Score> jerk(const Evaluation& evaluation, const JerkOptions& options) {
  const Context& context = evaluation.context;
  const Curve& curve = needed(context.curve, "jerk", "a curve");
  const Trajectory& reference = needed(context.reference, "jerk", "the complete reference");
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
    throw Undefined("jerk: curve and reference have no four consecutive samples in common at " +
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

}  // namespace loopbench::metrics
