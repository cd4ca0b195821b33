#include "metrics/segments/errors.hpp"

#include <algorithm>
#include <cmath>

#include "metrics/euler.hpp"
#include "metrics/motion.hpp"

namespace loopbench {

SegmentErrors segment_errors(const Evaluation& evaluation,
                             const std::vector<double>& distances,
                             const std::vector<FromTo>& pairs,
                             double length) {
  const Protocol& protocol = evaluation.protocol;
  const bool is_per_metre_gone = protocol.segments.end == SegmentEnd::eth3d;
  Rotation up_from_reference = Rotation::Identity();
  if (protocol.segments.up == PairsFrom::estimate) {
    up_from_reference = evaluation.alignment.reference_from_estimate.rotation.conjugate();
  }
  SegmentErrors out;
  for (const auto& [i, j] : pairs) {
    const Pose& P_j = evaluation.estimate[j].world_from_body;
    const Pose E = motion_error(protocol.form,
                                evaluation.reference[i].world_from_body,
                                evaluation.reference[j].world_from_body,
                                evaluation.estimate[i].world_from_body,
                                P_j);
    const double metres = E.translation.norm();
    const double radians = rotation_angle(protocol.angle, E.rotation);
    const double per = is_per_metre_gone ? distances[j] - distances[i] : length;
    const Rotation up_from_body = up_from_reference * P_j.rotation;
    const Euler turn = euler(up_from_body * E.rotation * up_from_body.conjugate());
    out.start.push_back(i);
    out.translation_share.push_back(metres / per);
    out.rotation_rate.push_back(radians / per);
    out.translation.push_back(metres);
    out.rotation.push_back(radians);
    out.yaw.push_back(std::abs(turn.yaw));
    out.gravity.push_back(std::hypot(turn.roll, turn.pitch));
  }
  return out;
}

std::vector<float> float_distances(const Trajectory& trajectory) {
  std::vector<float> out{0.0F};
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Vector3 step =
        trajectory[i - 1].world_from_body.translation - trajectory[i].world_from_body.translation;
    const auto dx = static_cast<float>(step.x());
    const auto dy = static_cast<float>(step.y());
    const auto dz = static_cast<float>(step.z());
    out.push_back(out.back() + std::sqrt(dx * dx + dy * dy + dz * dz));
  }
  return out;
}

SegmentErrors float_segment_errors(const Evaluation& evaluation,
                                   const std::vector<FromTo>& pairs,
                                   float length) {
  SegmentErrors out;
  for (const auto& [i, j] : pairs) {
    const Pose E = motion_error(ErrorForm::kitti,
                                evaluation.reference[i].world_from_body,
                                evaluation.reference[j].world_from_body,
                                evaluation.estimate[i].world_from_body,
                                evaluation.estimate[j].world_from_body);
    const Matrix3 R = E.rotation.toRotationMatrix();
    const auto a = static_cast<float>(R(0, 0));
    const auto b = static_cast<float>(R(1, 1));
    const auto c = static_cast<float>(R(2, 2));
    const auto cosine = static_cast<float>(0.5 * (static_cast<double>(a + b + c) - 1.0));
    const float radians = std::acos(std::max(std::min(cosine, 1.0F), -1.0F));
    const auto dx = static_cast<float>(E.translation.x());
    const auto dy = static_cast<float>(E.translation.y());
    const auto dz = static_cast<float>(E.translation.z());
    const float metres = std::sqrt(dx * dx + dy * dy + dz * dz);
    out.start.push_back(i);
    out.translation_share.push_back(static_cast<double>(metres / length));
    out.rotation_rate.push_back(static_cast<double>(radians / length));
  }
  return out;
}

double float_mean(const std::vector<double>& values) {
  float sum = 0.0F;
  for (const double value : values) sum += static_cast<float>(value);
  return static_cast<double>(sum / static_cast<float>(values.size()));
}

}  // namespace loopbench
