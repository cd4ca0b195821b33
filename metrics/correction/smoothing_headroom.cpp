#include "metrics/correction/smoothing_headroom.hpp"

#include <bit>
#include <stdexcept>

#include "metrics/correction/low_pass.hpp"

namespace loopbench::metrics {
namespace {

/// Keeps the first pose of repeated stamps (association evo).
Series error_series(const Evaluation& evaluation) {
  Series out;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    const auto& [stamp, truth] = evaluation.reference[i];
    if (i > 0 && stamp <= out.times.back()) continue;
    out.times.push_back(stamp);
    out.values.push_back(evaluation.estimate[i].world_from_body.translation - truth.translation);
  }
  return out;
}

Statistics magnitudes(const std::vector<Vector3>& vectors, int ddof) {
  std::vector<double> out;
  out.reserve(vectors.size());
  for (const Vector3& vector : vectors) out.push_back(vector.norm());
  return statistics(std::move(out), ddof);
}

}  // namespace

std::vector<Score> smoothing_headroom(const Evaluation& evaluation,
                                      const SmoothingHeadroomOptions& options) {
  Series errors = error_series(evaluation);
  if (errors.times.size() < 2) {
    throw Undefined("smoothing_headroom: needs two poses with different stamps");
  }
  const int ddof = evaluation.protocol.ddof;
  const bool is_sharp = options.filter == Filter::sharp;
  if (is_sharp) errors = resample(errors, std::bit_ceil(2 * errors.times.size()));
  const Statistics before = magnitudes(errors.values, ddof);
  if (before.rmse == 0.0) {
    throw Undefined("smoothing_headroom: the error is zero");
  }
  const Statistics after = magnitudes(
      is_sharp ? low_pass(errors, options.window) : moving_average(errors, options.window), ddof);
  return descriptions({{"before", "3d", "m", before},
                       {"after", "3d", "m", after},
                       single("gain", "3d", "%", 100.0 * (1.0 - after.rmse / before.rmse))});
}

}  // namespace loopbench::metrics
