#include "metrics/checks/lever_arm.hpp"

#include <cmath>

#include "metrics/trajectory/position_only.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::array kParameterNames{"x", "y", "z", "t"};

Score of_parameter(const PointOffset& fit, const char* relation, int i, double value) {
  const auto k = static_cast<std::size_t>(i);
  const bool is_time = i == 3;
  const char* const axis = is_time ? "" : kParameterNames[k];
  const std::string name = is_time ? std::string("offset") + relation : relation + std::string("");
  if (fit.is_observable[k]) return single(name, axis, is_time ? "s" : "m", value);
  return {
      name,
      axis,
      is_time ? "s" : "m",
      {},
      "not observable on this path: this body axis changes its direction by less than 0.1 rad, or "
      "the body does not move"};
}

}  // namespace

std::vector<Score> lever_arm(const Evaluation& evaluation, const LeverArmOptions& options) {
  const Trajectory& reference =
      needed(evaluation.context.reference, "lever_arm", "the complete reference");
  const Trajectory& estimate =
      needed(evaluation.context.estimate, "lever_arm", "the complete estimate");
  if (is_position_only(estimate)) throw Undefined("lever_arm: the estimate has no rotations");
  const Align align = evaluation.protocol.align;
  const bool with_scale = align == Align::sim3 || align == Align::scale;
  const PointOffset fit = fit_point_offset(reference, estimate, with_scale, options.longest);
  std::vector<Score> out;
  for (int i = 0; i < 3; ++i) out.push_back(of_parameter(fit, "position", i, fit.lever_arm[i]));
  for (int i = 0; i < 3; ++i) out.push_back(of_parameter(fit, "half_width", i, fit.half_width(i)));
  out.push_back(of_parameter(fit, "", 3, fit.offset));
  out.push_back(of_parameter(fit, "_half_width", 3, fit.half_width(3)));
  for (int i = 0; i < PointOffset::kParameters; ++i) {
    for (int k = i + 1; k < PointOffset::kParameters; ++k) {
      if (!fit.is_observable[static_cast<std::size_t>(i)] ||
          !fit.is_observable[static_cast<std::size_t>(k)]) {
        continue;
      }
      const double deviations = std::sqrt(fit.covariance(i, i) * fit.covariance(k, k));
      const std::string pair = kParameterNames[static_cast<std::size_t>(i)] +
                               std::string(kParameterNames[static_cast<std::size_t>(k)]);
      out.push_back(single(
          "correlation", pair, "1", deviations > 0.0 ? fit.covariance(i, k) / deviations : 0.0));
    }
  }
  out.push_back(single("ate_before", "", "m", fit.rmse_before));
  out.push_back(single("ate_after", "", "m", fit.rmse));
  out.push_back(single("points", "", "1", static_cast<double>(fit.points)));
  return descriptions(std::move(out));
}

}  // namespace loopbench::metrics
