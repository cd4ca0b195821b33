#include "metrics/checks/body_offset.hpp"

#include <cmath>
#include <numbers>

namespace loopbench::metrics {
namespace {

constexpr std::size_t kFewest = 20;      // relative poses
constexpr double kExplainsOffset = 0.5;  // share of the squares explained, for a warning
constexpr double kDegree = std::numbers::pi / 180.0;

std::string listed(const Vector3& place) {
  std::string out;
  for (const double value : place) {
    out += (out.empty() ? "" : ",") + to_text(std::round(value * 1e3) / 1e3 + 0.0);
  }
  return out;
}

/// In the format of the option `--ref-body`.
std::string place_text(const Pose& body_from_reference) {
  std::string out = listed(body_from_reference.translation);
  if (log_so3(body_from_reference.rotation).norm() < 1e-6) return out;
  const double sign = body_from_reference.rotation.w() < 0.0 ? -1.0 : 1.0;
  for (const double value : body_from_reference.rotation.coeffs()) {
    out += "," + to_text(std::round(sign * value * 1e5) / 1e5 + 0.0);
  }
  return out;
}

std::string percent(double part) { return std::to_string(std::lround(100.0 * part)) + " %"; }

}  // namespace

std::optional<BodyOffset> body_offset(const Trajectory& reference,
                                      const Trajectory& estimate,
                                      const BodyOffsetOptions& options) {
  const auto stretches =
      turning_stretches(reference, estimate, options.turn * kDegree, options.longest);
  if (stretches.size() < kFewest) return std::nullopt;
  return BodyOffset{hand_eye(stretches), stretches.size()};
}

std::optional<BodyOffset> body_offset(const Evaluation& evaluation,
                                      const BodyOffsetOptions& options) {
  const bool is_flat = evaluation.protocol.project != Plane::none;
  if (is_flat || !why_no_attitude(evaluation).empty()) return std::nullopt;
  return body_offset(evaluation.reference, evaluation.estimate, options);
}

std::string other_body(const BodyOffset& offset, const Pose& stated) {
  HandEye fit = offset.fit;
  const bool is_turned = fit.turn_explained >= kExplainsOffset;
  const bool is_aside = fit.lever_explained >= kExplainsOffset;
  if (!is_turned && !is_aside) return "";
  if (!is_aside) fit.body_from_reference.translation.setZero();
  std::string out = "the reference seems to track another body, with the offset " +
                    place_text(fit.body_from_reference * stated) + " in the estimate's body frame";
  if (is_aside) out += " (+- " + listed(fit.deviation) + " m)";
  out += ": over rotations, ";
  if (is_turned) {
    out += "the rotation explains " + percent(fit.turn_explained) + " of the squared differences";
  }
  if (is_turned && is_aside) out += " and ";
  if (is_aside) {
    out += "the lever arm explains " + percent(fit.lever_explained);
    out += is_turned ? " of the rest" : " of the squared differences";
  }
  return out;
}

std::vector<Score> body_offset_scores(const Evaluation& evaluation,
                                      const BodyOffsetOptions& options) {
  const auto found = body_offset(evaluation, options);
  if (!found) {
    throw Undefined("too few rotations, or orientations or unprojected positions are missing");
  }
  const auto& [rotation, at] = found->fit.body_from_reference;
  std::vector<Score> out;
  constexpr const char* kAxes[] = {"x", "y", "z", "w"};
  for (int i = 0; i < 3; ++i) out.push_back(single("position", kAxes[i], "m", at[i]));
  for (int i = 0; i < 3; ++i) {
    out.push_back(single("deviation", kAxes[i], "m", found->fit.deviation[i]));
  }
  for (int i = 0; i < 4; ++i) {
    out.push_back(single("attitude", kAxes[i], "1", rotation.coeffs()[i]));
  }
  out.push_back(single("turn", "", "deg", log_so3(rotation).norm() / kDegree));
  out.push_back(single("turn_explained", "", "%", 100.0 * found->fit.turn_explained));
  out.push_back(single("position_explained", "", "%", 100.0 * found->fit.lever_explained));
  out.push_back(single("stretches", "", "1", static_cast<double>(found->stretches)));
  return descriptions(std::move(out));
}

}  // namespace loopbench::metrics
