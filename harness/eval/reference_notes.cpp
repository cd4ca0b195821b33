#include "harness/eval/reference_notes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "datasets/core/fields.hpp"
#include "metrics/errors/ate.hpp"

namespace loopbench::harness {

std::string shared_datum(const metrics::Evaluation& evaluation, bool is_one_datum) {
  constexpr double kNear = 0.1, kHidden = 0.5;
  const metrics::Alignment& fit = evaluation.alignment;
  const bool is_projected = evaluation.protocol.project != metrics::ProjectionPlane::none;
  if (fit.type == metrics::Align::none || is_projected) return "";
  const Pose estimate_from_reference = fit.reference_from_estimate.inverse();
  const auto& pairs = evaluation.reference;
  Vector3 mean = Vector3::Zero();
  for (const auto& [stamp, pose] : pairs) {
    mean += pose.translation / static_cast<double>(pairs.size());
  }
  double size = 0.0, aligned = 0.0, unaligned = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Vector3& expected = pairs[i].world_from_body.translation;
    const Vector3& found = evaluation.estimate[i].world_from_body.translation;
    size += (expected - mean).squaredNorm();
    aligned += (found - expected).squaredNorm();
    unaligned += (estimate_from_reference * found / fit.scale - expected).squaredNorm();
  }
  const bool is_near =
      unaligned <= kNear * kNear * size && aligned <= kHidden * kHidden * unaligned;
  if (!is_one_datum && !is_near) return "";
  const auto count = static_cast<double>(pairs.size());
  return fmt::format(
      "datum: both files {} in one frame: ATE {:.4g} m without alignment (--align none), {:.4g} m "
      "with {}",
      is_one_datum ? "are" : "seem to be",
      std::sqrt(unaligned / count),
      std::sqrt(aligned / count),
      to_text(fit.type));
}

std::string reference_error(const metrics::Evaluation& evaluation, double sigma) {
  if (sigma == 0.0) return "";
  const double own = std::sqrt(3.0) * sigma;
  const double error = metrics::ate(evaluation, {}).front().statistics.rmse;
  const std::string text =
      fmt::format("reference: {:g} m per axis are a position error of {:.3g} m (rmse)", sigma, own);
  if (error <= own) {
    return text + fmt::format(": the ATE of {:.3g} m is below it and shows nothing else", error);
  }
  return text + fmt::format("; without it, an ATE of {:.4g} m would be about {:.4g} m",
                            error,
                            std::sqrt(error * error - own * own));
}

}  // namespace loopbench::harness
