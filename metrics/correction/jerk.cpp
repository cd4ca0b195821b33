#include "metrics/correction/jerk.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "datasets/core/polyline.hpp"
#include "metrics/numerics/divided_differences.hpp"
#include "metrics/numerics/stamp_rounding.hpp"

namespace loopbench {
namespace {

constexpr double kMostSamples = 1e8;  // 6 GB: a rate beyond this is a slip

/// Stamps of the curve's clock inside both spans, `rate` a second.
std::vector<double> grid(const Curve& curve,
                         const Trajectory& reference,
                         double offset,
                         double rate) {
  const double begin = std::max(curve.start(), reference.front().stamp - offset);
  const double end = std::min(curve.end(), reference.back().stamp - offset);
  if (!((end - begin) * rate < kMostSamples)) {
    throw std::runtime_error("jerk: rate = " + to_text(rate) + " asks for too many samples");
  }
  std::vector<double> out;
  for (double k = 0.0; begin + k / rate <= end; ++k) out.push_back(begin + k / rate);
  return out;
}

/// [m/s^3] at four samples in a row.
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
  const Trajectory& reference = needed(context.reference, "jerk", "the whole reference");
  const double offset = context.protocol.offset;
  const std::vector<double> times = grid(curve, reference, offset, options.rate);
  std::vector<double> reference_times;
  for (const double time : times) {
    reference_times.push_back(
        std::clamp(time + offset, reference.front().stamp, reference.back().stamp));
  }
  const Trajectory ours = curve.sample(times);
  const Trajectory theirs = Polyline(reference).sample(reference_times);

  std::vector<double> estimate_jerk;
  std::vector<double> reference_jerk;
  double gap_until = -std::numeric_limits<double>::infinity();  // end of the last gap met
  std::size_t looked = 0;
  for (std::size_t i = 0; i + 3 < times.size(); ++i) {
    // Gaps that begin before the stretch ends; the last of them is the only one that can reach it.
    while (looked + 1 < reference.size() && reference[looked].stamp < theirs[i + 3].stamp) {
      const double gap = reference[looked + 1].stamp - reference[looked].stamp;
      if (gap > options.max_gap + kStampRounding) gap_until = reference[looked + 1].stamp;
      ++looked;
    }
    if (gap_until > theirs[i].stamp) continue;
    estimate_jerk.push_back(evaluation.alignment.scale * jerk_of(&ours[i]));
    reference_jerk.push_back(jerk_of(&theirs[i]));
  }
  if (estimate_jerk.empty()) {
    throw Undefined("jerk: curve and reference share no four samples at " + to_text(options.rate) +
                    " a second without a gap");
  }
  const int ddof = evaluation.protocol.ddof;
  Score estimate{"estimate", "3d", "m/s^3", statistics(std::move(estimate_jerk), ddof)};
  Score truth{"reference", "3d", "m/s^3", statistics(std::move(reference_jerk), ddof)};
  Score ratio{"ratio", "3d", "1", {}, "the reference has no jerk to compare with"};
  if (truth.statistics.rmse > 0.0) {
    ratio = single("ratio", "3d", "1", estimate.statistics.rmse / truth.statistics.rmse);
  }
  return {directed(std::move(estimate), Better::neither),
          directed(std::move(truth), Better::neither),
          directed(std::move(ratio), Better::target, 1.0)};
}

}  // namespace loopbench
