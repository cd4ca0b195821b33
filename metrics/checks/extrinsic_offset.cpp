#include "metrics/checks/extrinsic_offset.hpp"

#include <cmath>
#include <numbers>

namespace loopbench::metrics {
namespace {

constexpr std::size_t kFewest = 20;      // relative poses
constexpr double kExplainsOffset = 0.5;  // share of the squares explained, for a warning
constexpr double kDegree = std::numbers::pi / 180.0;

std::string listed(const Vector3& position) {
  std::string out;
  for (const double value : position) {
    out += (out.empty() ? "" : ",") + to_text(std::round(value * 1e3) / 1e3 + 0.0);
  }
  return out;
}

std::string percent(double part) { return std::to_string(std::lround(100.0 * part)) + " %"; }

}  // namespace

std::string body_option(const Pose& body_from_reference) {
  std::string out = listed(body_from_reference.translation);
  if (log_so3(body_from_reference.rotation).norm() < 1e-6) return out;
  const double sign = body_from_reference.rotation.w() < 0.0 ? -1.0 : 1.0;
  for (const double value : body_from_reference.rotation.coeffs()) {
    out += "," + to_text(std::round(sign * value * 1e5) / 1e5 + 0.0);
  }
  return out;
}

std::optional<ExtrinsicOffset> extrinsic_offset(const Trajectory& reference,
                                                const Trajectory& estimate,
                                                const ExtrinsicOffsetOptions& options) {
  const auto relative_poses =
      rotating_intervals(reference, estimate, options.rotation * kDegree, options.longest);
  if (relative_poses.size() < kFewest) return std::nullopt;
  return ExtrinsicOffset{hand_eye(relative_poses), relative_poses.size()};
}

std::optional<ExtrinsicOffset> extrinsic_offset(const Evaluation& evaluation,
                                                const ExtrinsicOffsetOptions& options) {
  const bool is_flat = evaluation.protocol.project != ProjectionPlane::none;
  if (is_flat || !why_no_attitude(evaluation).empty()) return std::nullopt;
  return extrinsic_offset(evaluation.reference, evaluation.estimate, options);
}

std::string other_body(const ExtrinsicOffset& offset, const Pose& stated) {
  HandEye fit = offset.fit;
  const bool is_turned = fit.rotation_explained >= kExplainsOffset;
  const bool is_aside = fit.lever_arm_explained >= kExplainsOffset;
  if (!is_turned && !is_aside) return "";
  if (!is_aside) fit.body_from_reference.translation.setZero();
  std::string out = "the reference seems to track another body, with the offset " +
                    body_option(fit.body_from_reference * stated) + " in the estimate's body frame";
  if (is_aside) out += " (+- " + listed(fit.deviation) + " m)";
  out += ": over rotations, ";
  if (is_turned) {
    out +=
        "the rotation explains " + percent(fit.rotation_explained) + " of the squared differences";
  }
  if (is_turned && is_aside) out += " and ";
  if (is_aside) {
    out += "the lever arm explains " + percent(fit.lever_arm_explained);
    out += is_turned ? " of the rest" : " of the squared differences";
  }
  return out;
}

std::vector<Score> extrinsic_offset_scores(const Evaluation& evaluation,
                                           const ExtrinsicOffsetOptions& options) {
  const auto found = extrinsic_offset(evaluation, options);
  if (!found) {
    throw Undefined("too few rotations, or orientations or unprojected positions are missing");
  }
  const auto& [rotation, at] = found->fit.body_from_reference;
  std::vector<Score> out;
  constexpr const char* kAxes[] = {"x", "y", "z", "w"};
  for (int i = 0; i < 3; ++i) out.push_back(single("position", kAxes[i], "m", at[i]));
  for (int i = 0; i < 3; ++i) {
    out.push_back(single("position_std", kAxes[i], "m", found->fit.deviation[i]));
  }
  for (int i = 0; i < 4; ++i) {
    out.push_back(single("quaternion", kAxes[i], "1", rotation.coeffs()[i]));
  }
  out.push_back(single("rotation", "", "deg", log_so3(rotation).norm() / kDegree));
  out.push_back(single("rotation_explained", "", "%", 100.0 * found->fit.rotation_explained));
  out.push_back(single("lever_arm_explained", "", "%", 100.0 * found->fit.lever_arm_explained));
  out.push_back(single("relative_poses", "", "1", static_cast<double>(found->relative_poses)));
  return descriptions(std::move(out));
}

}  // namespace loopbench::metrics
